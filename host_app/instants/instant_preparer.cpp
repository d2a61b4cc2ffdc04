#include "host_app/instants/instant_preparer.h"

namespace vantage {

std::span<const PrepareLevel> prepare_levels() {
    using Refinement = PrepareLevel::Refinement;
    static constexpr PrepareLevel levels[] = {
        {0, most_drawn_rigs, Refinement::sweep},
        {1, most_drawn_rigs, Refinement::carve},
        {2, most_drawn_rigs, Refinement::none},
        {3, 2, Refinement::none, false},
    };
    return levels;
}

}  // namespace vantage
