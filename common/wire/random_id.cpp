#include "common/wire/random_id.h"

#include <random>

namespace vantage {

std::uint64_t random_id() {
    std::random_device entropy;
    std::uniform_int_distribution<std::uint64_t> any(1);
    return any(entropy);
}

}  // namespace vantage
