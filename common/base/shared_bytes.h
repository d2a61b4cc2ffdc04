#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace vantage {

/// Shared and never changed; may be null.
using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

}  // namespace vantage
