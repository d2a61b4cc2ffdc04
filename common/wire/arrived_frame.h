#pragma once

#include <functional>
#include <memory>

#include "common/base/time/time.h"
#include "common/wire/frame_codec.h"

namespace vantage {

/// A frame as received from a rig, not decoded. Immutable, with shared ownership.
struct ArrivedFrame {
    std::size_t rig = 0;  ///< index in the stage
    std::shared_ptr<const PackedFrame> packed;
    LinkCounters link;
    MonotonicTime arrival{};
    TaiTime arrival_tai{};
};

/// Called with every received frame on the receiving thread; it must never block.
using FrameTap = std::function<void(const ArrivedFrame&)>;

}  // namespace vantage
