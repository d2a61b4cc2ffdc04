#pragma once

#include <GLES3/gl31.h>
#include <opencv2/core.hpp>

#include "common/gl/framebuffer.h"
#include "common/gl/gl_handle.h"
#include "common/gl/texture.h"

namespace vantage {

inline void delete_renderbuffer(GLuint name) { glDeleteRenderbuffers(1, &name); }

/// What a picture of one size is drawn into: four samples a pixel for colour, one for depth.
class StageTargets {
  public:
    /// Throws Error if the driver cannot or memory is short.
    explicit StageTargets(cv::Size size);

    cv::Size size() const { return size_; }
    void bind_colour() const;
    /// Averages the samples and reads the picture back.
    void read_colour(cv::Mat& image) const;
    void bind_depth() const { depth_target_.bind(); }
    /// As CV_32SC1 holding the bits of floats.
    void read_depth_bits(cv::Mat& image) const { depth_target_.read(0, image); }

  private:
    cv::Size size_;
    GlHandle<delete_renderbuffer> colour_samples_, depth_samples_;
    GlHandle<delete_framebuffer> sampled_;
    Texture resolved_, depth_bits_, depth_order_;
    Framebuffer resolved_target_, depth_target_;
};

}  // namespace vantage
