#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "host_app/background/background_stereo.h"

namespace vantage {

// The costs of background stereo: how well the other rigs' pictures agree with each depth of each
// pixel. The functions return early, with an incomplete result, once `stop` is requested.

/// A cost in fixed point. The largest one of a comparison of colours is 256.
using Cost = std::int16_t;

/// The inverse depths that are tried at a pixel, by label: first some that are the same at every
/// pixel, then those of planes.
struct DepthLabels {
    float farthest = 0, step = 0;  ///< 1/m
    int depths = 0;                ///< of which there are at least 2, unless nothing is known
    /// Factors of the planes' inverse depths, by (u, v, 1).
    std::vector<Eigen::Vector3f> planes = {};
    bool has_floor = false;  ///< which is the first plane

    float at(float depth) const { return farthest + step * depth; }
    int count() const { return depths + static_cast<int>(planes.size()); }
    float of_plane(std::size_t plane, int y, int x) const {
        return planes[plane].dot(Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), 1));
    }
    float of_label(int label, int y, int x) const {
        return label < depths ? at(static_cast<float>(label))
                              : of_plane(static_cast<std::size_t>(label - depths), y, x);
    }
    /// The depth next to an inverse depth, -1 outside the range.
    int nearest_to(float inverse_m) const {
        const float depth = std::round((inverse_m - farthest) / step);
        return depth >= 0 && depth < static_cast<float>(depths) ? static_cast<int>(depth) : -1;
    }
};

/// Costs of all labels at all pixels; those of one pixel are contiguous.
class CostVolume {
  public:
    CostVolume(cv::Size size, int labels)
        : size_(size),
          labels_(labels),
          costs_(static_cast<std::size_t>(size.area()) * static_cast<std::size_t>(labels)) {}

    cv::Size size() const { return size_; }
    int labels() const { return labels_; }
    Cost* at(int y, int x) { return costs_.data() + offset(y, x); }
    const Cost* at(int y, int x) const { return costs_.data() + offset(y, x); }

  private:
    std::size_t offset(int y, int x) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(labels_);
    }
    cv::Size size_;
    int labels_;
    std::vector<Cost> costs_;
};

/// Enlargement of the other pictures, whose nearest pixel is read instead of interpolating.
constexpr int fineness = 5;

/// Another rig, as the swept rig sees it.
struct OtherView {
    Eigen::Matrix4f from_pixel;
    cv::Mat4b fine;
    /// The least and the greatest inverse depth of each pixel and its neighbours to the right and
    /// below, 0 = unknown; empty in the first pass.
    cv::Mat2f inverse_depths;
    int columns() const { return fine.cols / fineness; }
    int rows() const { return fine.rows / fineness; }
};

/// Mean difference of two colours, 0 to 255.
inline float difference(const cv::Vec4b& a, const cv::Vec4b& b) {
    return static_cast<float>(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) +
                              std::abs(a[2] - b[2])) /
           3;
}

/// The costs of a rig's pixels. They combine the two others whose pictures match best, and the
/// rig's own right image.
CostVolume swept(const BackgroundView& view, std::span<const OtherView> others,
                 const std::optional<OtherView>& right, const DepthLabels& labels,
                 const std::stop_token& stop);

/// Averages costs over 3x3 pixels of similar colour. Adds the penalties for leaving the depth of
/// the rig's own matcher, planes, and the floor.
CostVolume smoothed(const CostVolume& costs, const BackgroundView& view, const DepthLabels& labels,
                    const std::stop_token& stop);

}  // namespace vantage
