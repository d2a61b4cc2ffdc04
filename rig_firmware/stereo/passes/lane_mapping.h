#pragma once

#include "common/gl/shader_library.h"

namespace vantage {

/// Which way invocations lie over the cost volume, fixed when Vantage is built for a GPU
/// (-DVANTAGE_LANES=pixels|disparities): pixels for CPUs (llvmpipe) and wide GPUs, disparities for
/// GPUs with few registers a lane, such as a Raspberry Pi's V3D.
enum class LaneMapping { pixels = 0, disparities = 1 };

constexpr LaneMapping lane_mapping() {
#ifdef VANTAGE_LANES_DISPARITIES
    return LaneMapping::disparities;
#else
    return LaneMapping::pixels;
#endif
}

inline ShaderDefines lane_defines(LaneMapping mapping = lane_mapping()) {
    return {{"LANE_MAPPING", mapping == LaneMapping::disparities ? "1" : "0"}};
}

}  // namespace vantage
