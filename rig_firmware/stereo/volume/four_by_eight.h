#pragma once

#include <string>

#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Passes over pictures whose invocations make four pixels of each of eight rows: their neighbours
/// then come with few loads.
namespace four_by_eight {

inline constexpr int rows = 8;

/// The program of a shader that takes ROWS.
inline Program program(const ShaderLibrary& library, const char* shader,
                       ShaderDefines defines = {}) {
    defines.emplace_back("ROWS", std::to_string(rows));
    return Program::compute(library, shader, std::move(defines));
}

/// Runs `program`, whose buffers are bound, with its uniforms `size` and `stride` set.
inline void run(Program& program, const StereoLayout& layout) {
    program.use();
    program.set("size", Eigen::Vector2i(layout.width_px, layout.height_px));
    program.set("stride", layout.stride_px());
    program.dispatch_over((layout.width_px + 3) / 4, (layout.height_px + rows - 1) / rows);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace four_by_eight
}  // namespace vantage
