#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vantage {

/// A frame that a rig keeps on its disk, as it goes to a host that fetches it: the four parts that
/// follow the RigMessage of its delivery. What is in them: common/take/kept_frame.h.
struct KeptParts {
    std::uint64_t pulse = 0;  ///< for the rig; does not travel
    std::vector<std::byte> head, record, colour, depth;

    std::size_t bytes() const { return head.size() + record.size() + colour.size() + depth.size(); }
};

}  // namespace vantage
