#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vantage {

/// A frame of a rig's own recording on its way to a host that fetches it: the four message parts
/// that follow a RigMessage. common/take/kept_frame.h has their content.
struct KeptParts {
    std::uint64_t pulse = 0;  ///< for the rig; not sent
    std::vector<std::byte> head, record, colour, depth;

    std::size_t bytes() const { return head.size() + record.size() + colour.size() + depth.size(); }
};

}  // namespace vantage
