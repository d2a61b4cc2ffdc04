#include "common/virtual_stage/stage_targets.h"

namespace vantage {
namespace {

/// Copies between buffers of one format: software rasterisers copy their bytes.
void copy(const Framebuffer& from, const Framebuffer& to, std::span<const cv::Rect> parts,
          int scale) {
    to.bind();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, from.name());
    for (const cv::Rect& part : parts) {
        const int left = scale * part.x, top = scale * part.y, right = scale * part.br().x,
                  bottom = scale * part.br().y;
        glBlitFramebuffer(left, top, right, bottom, left, top, right, bottom,
                          GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    }
}

}  // namespace

StageTargets::StageTargets(cv::Size size, int samples_per_side)
    : size_(size),
      samples_per_side_(samples_per_side),
      samples_(TextureFormat::rgba8, size.width * samples_per_side, size.height * samples_per_side,
               Filter::linear),
      sample_order_(TextureFormat::depth32f, samples_.width_px(), samples_.height_px()),
      reduced_(TextureFormat::rgba8, size.width, size.height),
      depth_bits_(TextureFormat::r32ui, size.width, size.height),
      depth_order_(TextureFormat::depth32f, size.width, size.height),
      sampled_target_({&samples_}, &sample_order_),
      reduced_target_({&reduced_}),
      depth_target_({&depth_bits_}, &depth_order_) {}

void StageTargets::copy_samples(const StageTargets& other, std::span<const cv::Rect> parts) const {
    copy(other.sampled_target_, sampled_target_, parts, samples_per_side_);
}

void StageTargets::copy_depth(const StageTargets& other) const {
    const cv::Rect whole({}, size_);
    copy(other.depth_target_, depth_target_, {&whole, 1}, 1);
}

void StageTargets::reduce_colour(FullscreenPass& reduce, std::span<const cv::Rect> parts) const {
    if (samples_per_side_ == 1) return;
    Program& program = reduce.use();
    program.input("samples", samples_);
    glEnable(GL_SCISSOR_TEST);
    for (const cv::Rect& part : parts) {
        glScissor(part.x, part.y, part.width, part.height);
        reduce.draw(reduced_target_);
    }
    glDisable(GL_SCISSOR_TEST);
}

void StageTargets::read_colour(cv::Mat& image) const {
    (samples_per_side_ == 1 ? sampled_target_ : reduced_target_).read(0, image);
}

}  // namespace vantage
