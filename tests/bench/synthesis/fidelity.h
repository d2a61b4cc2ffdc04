#pragma once

#include <string>

#include "common/image/image.h"

namespace vantage {

/// The share of pixels whose error, blurred by a box of 5x5, exceeds 24 of 255 grey levels in any
/// channel: what a person sees as wrong, not as soft or noisy.
double outliers(const ColourImage& picture, const ColourImage& truth);

/// How close pictures come to what a real camera would have seen; means over those that were added.
class Fidelity {
  public:
    void add(const ColourImage& picture, const ColourImage& truth);

    int pictures() const { return pictures_; }
    double psnr_db() const { return psnr_db_ / pictures_; }
    double ssim() const { return ssim_ / pictures_; }
    double outliers() const { return outliers_ / pictures_; }

  private:
    int pictures_ = 0;
    double psnr_db_ = 0, ssim_ = 0, outliers_ = 0;
};

/// How much the error of consecutive pictures changes against the noise of a camera: 1 is what a
/// real camera with that noise would flicker.
class Flicker {
  public:
    explicit Flicker(double noise_sigma) : noise_sigma_(noise_sigma) {}

    /// Pixels of `mask` (not 0) count. All of one size.
    void add(const ColourImage& before, const ColourImage& truth_before, const ColourImage& now,
             const ColourImage& truth_now, const cv::Mat1b& mask);
    /// 0: nothing was added.
    double against_a_camera() const;

  private:
    double noise_sigma_, sum_ = 0, pixels_ = 0;
};

}  // namespace vantage
