#include "host_app/views/depth_view.h"

#include <algorithm>

#include <Eigen/LU>

#include "common/config/yaml/number_checksum.h"
#include "host_app/views/projection.h"

namespace vantage {

DisparityScale::DisparityScale(const RectifiedStereo& geometry, int columns)
    : px_per_step_(static_cast<float>(static_cast<double>(geometry.width_px) /
                                      (static_cast<double>(columns) * disparity_steps_per_px))),
      doffs_px_(static_cast<float>(geometry.doffs_px())),
      f_baseline_(static_cast<float>(geometry.f_px * geometry.baseline_m)) {}

float DisparityScale::depth_m(std::uint16_t steps) const {
    const float d = static_cast<float>(steps) * px_per_step_ + doffs_px_;
    return steps != 0 && d > 0 ? f_baseline_ / d : 0.0f;
}

DepthView depth_view_of(const RigFrame& frame) {
    DepthView view;
    view.name = frame.rig;
    view.colour = frame.colour;
    view.K = frame.geometry.K_left();
    view.world_from_camera = frame.world_from_camera;
    view.disparity = frame.disparity;
    if (!frame.disparity.empty())
        view.disparity_scale = DisparityScale(frame.geometry, frame.disparity.cols);
    view.baseline_m = frame.geometry.baseline_m;
    view.doffs_px = frame.geometry.doffs_px();
    view.right_jpeg = frame.right_jpeg;
    return view;
}

std::vector<DepthView> depth_views_of(const FrameSet& set,
                                      const std::map<std::string, ColourCorrection>& colours) {
    std::vector<DepthView> views;
    for (const FrameSet::Slot& slot : set.slots) {
        if (!slot.frame || !slot.frame->has_pictures()) continue;
        views.push_back(depth_view_of(*slot.frame));
        const auto colour = colours.find(slot.rig);
        if (colour != colours.end()) views.back().colour_correction = colour->second;
    }
    return views;
}

namespace {

/// Rows and columns of the sampling grid: enough for ranking views, and cheap for every frame.
constexpr int samples_per_side = 12;

}  // namespace

std::string calibration_of(const DepthView& camera, cv::Size colour_size, cv::Size depth_size) {
    NumberChecksum sum;
    sum.add_rows(camera.K);
    sum.add(camera.world_from_camera);
    sum.add(camera.baseline_m);
    sum.add(camera.doffs_px);
    for (const int side :
         {colour_size.width, colour_size.height, depth_size.width, depth_size.height})
        sum.add(side);
    return checksum_text(sum.hex());
}

SurfaceSamples surface_samples(const DepthView& view) {
    SurfaceSamples samples;
    if (!view.has_depth() || view.colour.empty()) return samples;
    const cv::Size size = view.depth_size();
    const Eigen::Matrix3d ray_from_pixel =
        scaled_intrinsics(view.K, static_cast<double>(size.width) / view.colour.cols,
                          static_cast<double>(size.height) / view.colour.rows)
            .inverse();
    std::vector<double> depths_m;
    for (int j = 0; j < samples_per_side; ++j)
        for (int i = 0; i < samples_per_side; ++i) {
            const int x = (2 * i + 1) * size.width / (2 * samples_per_side);
            const int y = (2 * j + 1) * size.height / (2 * samples_per_side);
            const double z = view.depth_m_at(x, y);
            if (!(z > 0)) continue;
            depths_m.push_back(z);
            const Eigen::Vector3d point = z * (ray_from_pixel * Eigen::Vector3d(x, y, 1));
            samples.points_m.push_back(view.world_from_camera * point);
        }
    if (depths_m.empty()) return samples;
    const auto middle = depths_m.begin() + static_cast<std::ptrdiff_t>(depths_m.size() / 2);
    std::nth_element(depths_m.begin(), middle, depths_m.end());
    samples.median_depth_m = *middle;
    return samples;
}

}  // namespace vantage
