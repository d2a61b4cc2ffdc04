#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// What a picture of one size is drawn into: several samples a pixel for colour, one, at the
/// pixel's centre, for depth. Samples lie in a square grid in a larger texture: a software
/// rasteriser draws four of them in the time of its four-fold multisampling, and textures and
/// highlights gain as well as edges. Their order is kept as floats, which a shader hands on
/// unchanged.
class StageTargets {
  public:
    /// `samples_per_side` is 1 or 2. Throws Error if the driver cannot or memory is short.
    StageTargets(cv::Size size, int samples_per_side);

    cv::Size size() const { return size_; }
    int samples_per_side() const { return samples_per_side_; }
    void bind_colour() const { sampled_target_.bind(); }
    void bind_depth() const { depth_target_.bind(); }

    /// Takes the samples of another one of its kind in these parts of the picture, or all its
    /// depth.
    void copy_samples(const StageTargets& other, std::span<const cv::Rect> parts) const;
    void copy_depth(const StageTargets& other) const;

    /// Makes pixels of the samples with `reduce` (stage_reduce.frag), in these parts of the picture
    /// only.
    void reduce_colour(FullscreenPass& reduce, std::span<const cv::Rect> parts) const;
    void read_colour(cv::Mat& image) const;
    /// As CV_32SC1 holding the bits of floats.
    void read_depth_bits(cv::Mat& image) const { depth_target_.read(0, image); }

  private:
    cv::Size size_;
    int samples_per_side_;
    Texture samples_, sample_order_, reduced_, depth_bits_, depth_order_;
    Framebuffer sampled_target_, reduced_target_, depth_target_;
};

}  // namespace vantage
