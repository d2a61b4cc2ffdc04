#include "host_app/desk/feed/stage_points.h"

#include "host_app/desk/feed/rig_points.h"

namespace vantage {
namespace {

/// So that a desk of many rigs is drawn as fast as one of few.
constexpr int most_points = 4000;

}  // namespace

std::vector<DeskPlan::Point> stage_points(const FrameSet& set) {
    std::vector<DeskPlan::Point> points;
    if (set.present() == 0) return points;
    for_each_rig_point(set, most_points / set.present(),
                       [&](const Eigen::Vector3d& at_m, const cv::Vec4b& rgba) {
                           points.push_back({at_m.cast<float>(), {rgba[0], rgba[1], rgba[2]}});
                       });
    return points;
}

}  // namespace vantage
