#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "host_app/views/depth_view.h"

namespace vantage {

/// How useful a view is for rendering a virtual view: the sum of 1 / (angle between the two
/// cameras' rays + a small angle) over the view's sample points that fall into the virtual picture.
/// 0 if none does.
double usefulness(std::span<const Eigen::Vector3d> sample_points_m,
                  const Eigen::Vector3d& source_centre_m, const VirtualView& target);

/// Selects the most useful of several views, at most `at_most`, best first, so that the cost of a
/// picture does not grow with the number of rigs. Views with usefulness 0 are left out. `views` is
/// a range of pointers to objects with camera() and sample_points_m().
template <class Pointers>
auto most_useful(const Pointers& views, const VirtualView& target, std::size_t at_most) {
    std::vector<std::pair<double, decltype(&*views[0])>> ranked;
    for (const auto& view : views)
        if (const double use = usefulness(view->sample_points_m(),
                                          view->camera().world_from_camera.translation(), target);
            use > 0)
            ranked.emplace_back(use, &*view);
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (ranked.size() > at_most) ranked.resize(at_most);
    std::vector<decltype(&*views[0])> best;
    best.reserve(ranked.size());
    for (const auto& [use, view] : ranked) best.push_back(view);
    return best;
}

}  // namespace vantage
