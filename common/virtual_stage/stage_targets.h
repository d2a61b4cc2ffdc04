#pragma once

#include <opencv2/core.hpp>

#include "common/gl/framebuffer.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/texture.h"

namespace vantage {

/// What a picture of one size is drawn into: several samples a pixel for colour, one, at the
/// pixel's centre, for depth. Samples lie in a square grid in a larger texture: a software
/// rasteriser draws four of them in the time of its four-fold multisampling, and textures and
/// highlights gain as well as edges.
class StageTargets {
  public:
    /// `samples_per_side` is 1 or 2. Throws Error if the driver cannot or memory is short.
    StageTargets(cv::Size size, int samples_per_side);

    cv::Size size() const { return size_; }
    int samples_per_side() const { return samples_per_side_; }
    void bind_colour() const { sampled_target_.bind(); }
    /// Makes pixels of the samples with `reduce` (stage_reduce.frag) and reads the picture back.
    void read_colour(FullscreenPass& reduce, cv::Mat& image) const;
    void bind_depth() const { depth_target_.bind(); }
    /// As CV_32SC1 holding the bits of floats.
    void read_depth_bits(cv::Mat& image) const { depth_target_.read(0, image); }

  private:
    cv::Size size_;
    int samples_per_side_;
    Texture samples_, sample_order_, reduced_, depth_bits_, depth_order_;
    Framebuffer sampled_target_, reduced_target_, depth_target_;
};

}  // namespace vantage
