#include "host_app/instants/depth_views.h"

#include <limits>

namespace vantage {

DepthImage depth_from_disparity(const DisparityImage& disparity, const RectifiedStereo& geometry) {
    DepthImage depth_m(disparity.size());
    const auto px_per_step =
        static_cast<float>(static_cast<double>(geometry.width_px) /
                           (static_cast<double>(disparity.cols) * disparity_steps_per_px));
    const auto doffs_px = static_cast<float>(geometry.doffs_px());
    const auto f_baseline = static_cast<float>(geometry.f_px * geometry.baseline_m);
    constexpr float nowhere = std::numeric_limits<float>::infinity();
    for (int y = 0; y < disparity.rows; ++y) {
        const std::uint16_t* steps = disparity[y];
        float* z = depth_m[y];
        for (int x = 0; x < disparity.cols; ++x) {
            const float d = static_cast<float>(steps[x]) * px_per_step + doffs_px;
            // A division without a branch is one that the compiler vectorises.
            z[x] = f_baseline / (steps[x] != 0 && d > 0 ? d : nowhere);
        }
    }
    return depth_m;
}

DepthView depth_view_of(const RigFrame& frame) {
    DepthView view;
    view.name = frame.rig;
    view.colour = frame.colour;
    view.K = frame.geometry.K_left();
    view.world_from_camera = frame.world_from_camera;
    view.depth_m = depth_from_disparity(frame.disparity, frame.geometry);
    view.baseline_m = frame.geometry.baseline_m;
    view.doffs_px = frame.geometry.doffs_px();
    return view;
}

}  // namespace vantage
