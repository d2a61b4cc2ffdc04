#include "common/virtual_stage/stage_targets.h"

namespace vantage {

StageTargets::StageTargets(cv::Size size, int samples_per_side)
    : size_(size),
      samples_per_side_(samples_per_side),
      samples_(TextureFormat::rgba8, size.width * samples_per_side, size.height * samples_per_side,
               Filter::linear),
      sample_order_(TextureFormat::depth24, samples_.width_px(), samples_.height_px()),
      reduced_(TextureFormat::rgba8, size.width, size.height),
      depth_bits_(TextureFormat::r32ui, size.width, size.height),
      depth_order_(TextureFormat::depth24, size.width, size.height),
      sampled_target_({&samples_}, &sample_order_),
      reduced_target_({&reduced_}),
      depth_target_({&depth_bits_}, &depth_order_) {}

void StageTargets::read_colour(FullscreenPass& reduce, cv::Mat& image) const {
    if (samples_per_side_ == 1) {
        sampled_target_.read(0, image);
        return;
    }
    Program& program = reduce.use();
    samples_.bind(0);
    program.set("samples", 0);
    reduce.draw(reduced_target_);
    reduced_target_.read(0, image);
}

}  // namespace vantage
