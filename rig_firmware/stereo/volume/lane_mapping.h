#pragma once

#include <string_view>

#include "common/gl/shader_library.h"

namespace vantage {

/// Which way invocations lie over the cost volume: pixels for CPUs (llvmpipe) and wide GPUs,
/// disparities for GPUs with few registers a lane, such as a Raspberry Pi's V3D or a Mali. Both
/// give the same bits.
enum class LaneMapping { pixels = 0, disparities = 1 };

/// The one for a GPU, by the name that OpenGL ES gives it.
LaneMapping lane_mapping_of(std::string_view renderer);
/// The one for the GPU of the current context.
LaneMapping lane_mapping_here();

inline ShaderDefines lane_defines(LaneMapping mapping) {
    return {{"LANE_MAPPING", mapping == LaneMapping::disparities ? "1" : "0"}};
}

}  // namespace vantage
