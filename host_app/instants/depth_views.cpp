#include "host_app/instants/depth_views.h"

namespace vantage {

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
    return view;
}

}  // namespace vantage
