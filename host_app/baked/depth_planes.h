#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "host_app/views/depth_view.h"

namespace vantage {

/// A view's depth map as local planes of inverse depth, as a bake needs it.
class DepthPlanes {
  public:
    enum Kind : unsigned char { unknown, inpainted, measured };

    /// The planes of a depth map in which 0 is unknown and negative depth is inpainted.
    explicit DepthPlanes(const DepthView& view);

    cv::Size size() const { return inverse_m_.size(); }
    const Eigen::Matrix3d& K() const { return K_; }
    Kind kind(int x, int y) const { return static_cast<Kind>(kinds_(y, x)); }
    /// Makes a pixel unknown.
    void drop(int x, int y);
    /// 1/m; 0 = unknown. Smoothed along planes.
    float inverse(int x, int y) const { return inverse_m_(y, x); }
    /// The inverse depth of the pixel's plane beside its middle, 1/m.
    float inverse_at(int x, int y, float dx, float dy) const {
        return inverse_m_(y, x) + dx * slopes_(y, x)[0] + dy * slopes_(y, x)[1];
    }
    /// The slope of the inverse depth, for each pixel to the right and down.
    Eigen::Vector2f slope(int x, int y) const { return {slopes_(y, x)[0], slopes_(y, x)[1]}; }
    /// Whether a pixel and the next one to the right, or below, lie on one surface: the edge filter
    /// of mesh_joints.glsl.
    bool joins_right(int x, int y) const { return (joints_(y, x) & 1) != 0; }
    bool joins_down(int x, int y) const { return (joints_(y, x) & 2) != 0; }
    /// Pixels of this view for a square metre of the pixel's surface.
    double pixels_per_square_m(int x, int y) const;
    /// Distance to the nearest depth edge as a confidence, as edge_confidence.frag has it.
    float edge_confidence(int x, int y) const;

  private:
    void fit(const cv::Mat1f& raw);
    void join();

    Eigen::Matrix3d K_, K_inverse_;
    cv::Mat1b kinds_, joints_;
    cv::Mat1f inverse_m_;
    cv::Mat2f slopes_;  ///< of the inverse depth, for each pixel to the right and down
};

/// The edge confidence of a view's picture, 0..255 (see edge_confidence.frag).
cv::Mat1b edge_confidence_of(const DepthImage& depth_m, cv::Size picture);

}  // namespace vantage
