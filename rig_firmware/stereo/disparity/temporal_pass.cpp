#include "rig_firmware/stereo/disparity/temporal_pass.h"

#include <string>

namespace vantage {

TemporalPass::TemporalPass(const ShaderLibrary& library, int width_px, int height_px)
    : exposure_(library),
      pass_(library, "temporal_disparity.frag",
            {{"MOST_CHANGE", std::to_string(max_still_change)},
             {"MOST_HOLDING_CHANGE", std::to_string(max_holding_change)},
             {"MOST_STEP", std::to_string(max_consistent_step)},
             {"VOTES", std::to_string(consistent_score)},
             {"FIRST_VOTES", std::to_string(first_score)},
             {"MOST_VOTES", std::to_string(max_score)}}),
      denoised_(TextureFormat::r16ui, width_px, height_px),
      states_{Texture(TextureFormat::r32ui, width_px, height_px),
              Texture(TextureFormat::r32ui, width_px, height_px)},
      targets_{Framebuffer({&denoised_, &states_[0]}), Framebuffer({&denoised_, &states_[1]})} {}

const Texture& TemporalPass::run(const Texture& disparity, const Texture& picture) {
    exposure_.run(picture);
    const std::size_t next = 1 - newest_;
    Program& program = pass_.use();
    program.input("disparity", disparity);
    program.input("picture", picture);
    program.input("state", states_[newest_]);
    program.set("has_state", has_state_ ? 1 : 0);
    exposure_.gain().bind_storage(0);
    pass_.overwrite(targets_[next]);
    newest_ = next;
    has_state_ = true;
    return denoised_;
}

}  // namespace vantage
