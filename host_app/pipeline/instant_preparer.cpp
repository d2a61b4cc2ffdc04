#include "host_app/pipeline/instant_preparer.h"

namespace vantage {

std::span<const PrepareLevel> prepare_levels() {
    static constexpr PrepareLevel levels[] = {
        {0, most_drawn_rigs},
        {1, 2},
        {2, 2, false},
        {3, 2, false, false, 3},
    };
    return levels;
}

}  // namespace vantage
