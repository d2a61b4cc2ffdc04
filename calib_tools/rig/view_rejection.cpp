#include "calib_tools/rig/view_rejection.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "calib_tools/rig/camera_solver.h"

namespace vantage {
namespace {

constexpr double usual_times = 3, usual_plus_px = 0.3, corner_sigmas = 6;

std::map<int, double> rms_by_board(const Bundle& bundle) {
    std::map<int, std::pair<double, double>> sums;
    for (const BundleView& view : bundle.views) {
        auto& [squares, count] = sums[view.board];
        squares += std::pow(bundle.view_rms_px(view), 2) * static_cast<double>(view.corners.size());
        count += static_cast<double>(view.corners.size());
    }
    std::map<int, double> rms;
    for (const auto& [board, sum] : sums) rms[board] = std::sqrt(sum.first / sum.second);
    return rms;
}

std::size_t drop_outlying_corners(Bundle& bundle) {
    const double limit = corner_sigmas * std::max(0.03, robust_sigma_px(bundle));
    std::size_t dropped = 0;
    for (BundleView& view : bundle.views)
        dropped += std::erase_if(view.corners, [&](const BoardCorner& corner) {
            return bundle.residual_px(view, corner).norm() > limit;
        });
    std::erase_if(bundle.views, [](const BundleView& view) { return view.corners.size() < 4; });
    return dropped;
}

}  // namespace

bool reject_bad_views(Bundle& bundle, std::vector<RejectedView>& rejected,
                      std::size_t& corners_left_out) {
    std::map<int, double> rms = rms_by_board(bundle);
    const std::size_t fewest = rms.size() - rms.size() / 3;
    while (rms.size() > std::max<std::size_t>(3, fewest)) {
        std::vector<double> sorted;
        for (const auto& [board, value] : rms) sorted.push_back(value);
        std::sort(sorted.begin(), sorted.end());
        const double usual = sorted[sorted.size() / 2];
        const auto worst =
            std::max_element(rms.begin(), rms.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        if (worst->second < std::max(usual_times * usual, usual + usual_plus_px)) break;
        rejected.push_back({worst->first, worst->second, usual});
        std::erase_if(bundle.views,
                      [&](const BundleView& view) { return view.board == worst->first; });
        if (!solve_robustly(bundle)) return false;
        rms = rms_by_board(bundle);
    }
    corners_left_out = drop_outlying_corners(bundle);
    return corners_left_out == 0 || solve_robustly(bundle);
}

}  // namespace vantage
