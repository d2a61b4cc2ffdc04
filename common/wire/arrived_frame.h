#pragma once

#include <functional>
#include <memory>

#include "common/base/time/time.h"
#include "common/wire/frame_codec.h"

namespace vantage {

/// A frame as it came from a rig, not decoded yet. Shared and never changed.
struct ArrivedFrame {
    std::size_t rig = 0;  ///< its place in the stage
    std::shared_ptr<const PackedFrame> packed;
    LinkCounters link;
    MonotonicTime arrival{};
    TaiTime arrival_tai{};
};

/// Is shown every frame that comes, on the thread that receives: it must never wait.
using FrameTap = std::function<void(const ArrivedFrame&)>;

}  // namespace vantage
