#include "host_app/views/depth_views.h"

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

}  // namespace vantage
