#include "rig_firmware/stereo/features/exposure_pass.h"

#include <string>

namespace vantage {
namespace {

constexpr int group_lanes = 64;

}  // namespace

ExposurePass::ExposurePass(const ShaderLibrary& library)
    : program_(Program::compute(library, "exposure_gain.comp",
                                {{"LANES", std::to_string(group_lanes)},
                                 {"COLUMNS", std::to_string(columns)},
                                 {"ROWS", std::to_string(rows)},
                                 {"MOST_FIRST_STEP", std::to_string(max_first_change)},
                                 {"MOST_STEP", std::to_string(max_change)},
                                 {"LEAST_CHANGE", std::to_string(min_gain_change)}})),
      exposure_((1 + columns * rows) * 4, GL_DYNAMIC_COPY) {}

void ExposurePass::run(const Texture& picture) {
    program_.use();
    program_.input("picture", picture);
    program_.set("has_luma", has_luma_ ? 1 : 0);
    exposure_.bind_storage(0);
    program_.dispatch_over(group_lanes, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    has_luma_ = true;
}

}  // namespace vantage
