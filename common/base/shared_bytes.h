#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace vantage {

/// Immutable bytes with shared ownership; may be null.
using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

}  // namespace vantage
