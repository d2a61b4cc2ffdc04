#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// The render targets for an image of one size: several colour samples per pixel, and one depth
/// sample at the pixel's centre. The samples lie in a square grid in a larger texture: a software
/// rasteriser draws four of them in the time of its 4x multisampling, and they also antialias
/// textures and highlights. Their order is stored as floats, which a shader passes on unchanged.
class StageTargets {
  public:
    /// `samples_per_side` is 1 or 2. Throws Error if the driver cannot draw it or memory runs out.
    StageTargets(cv::Size size, int samples_per_side);

    cv::Size size() const { return size_; }
    int samples_per_side() const { return samples_per_side_; }
    void bind_colour() const { sampled_target_.bind(); }
    void bind_depth() const { depth_target_.bind(); }

    /// Copies the samples of another target of the same size in these parts, or all its depth.
    void copy_samples(const StageTargets& other, std::span<const cv::Rect> parts) const;
    void copy_depth(const StageTargets& other) const;

    /// Filters samples to pixels with `reduce` (stage_reduce.frag), in these parts only.
    void reduce_colour(FullscreenPass& reduce, std::span<const cv::Rect> parts) const;
    void read_colour(cv::Mat& image) const;
    /// Reads depth as CV_32SC1 with the bits of floats.
    void read_depth_bits(cv::Mat& image) const { depth_target_.read(0, image); }

  private:
    cv::Size size_;
    int samples_per_side_;
    Texture samples_, sample_order_, reduced_, depth_bits_, depth_order_;
    Framebuffer sampled_target_, reduced_target_, depth_target_;
};

}  // namespace vantage
