#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/receive/frame_set.h"
#include "host_app/views/depth_views.h"
#include "host_app/views/projection.h"

namespace vantage {

/// Calls `visit` with points of the surfaces that the set's rigs see, evenly over their pictures:
/// where each is on the stage (metres), and the colour of its pixel. `most_of_a_rig`: how many at
/// the most of each.
template <class Visit>
void for_each_rig_point(const FrameSet& set, int most_of_a_rig, const Visit& visit) {
    for (const FrameSet::Slot& slot : set.slots) {
        if (!slot.frame) continue;
        const DepthView view = depth_view_of(*slot.frame);
        if (!view.has_depth() || view.colour.empty()) continue;
        const cv::Size size = view.depth_size();
        const double right = static_cast<double>(size.width) / view.colour.cols;
        const double down = static_cast<double>(size.height) / view.colour.rows;
        const Eigen::Matrix3d rays = scaled_intrinsics(view.K, right, down).inverse();
        const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(
                                         static_cast<double>(size.area()) / most_of_a_rig))));
        for (int y = 0; y < size.height; y += step)
            for (int x = 0; x < size.width; x += step)
                if (const double z = view.depth_m_at(x, y); z > 0)
                    visit(Eigen::Vector3d(view.world_from_camera *
                                          (z * (rays * Eigen::Vector3d(x, y, 1)))),
                          view.colour(std::min(view.colour.rows - 1, static_cast<int>(y / down)),
                                      std::min(view.colour.cols - 1, static_cast<int>(x / right))));
    }
}

}  // namespace vantage
