#include "host_app/synthesis/stereoscopy.h"

#include <algorithm>
#include <cassert>

#include "common/base/error.h"
#include "host_app/instants/surface_samples.h"

namespace vantage {
namespace {

constexpr double far_parallax_widths = 0.02;

VirtualView eye(const VirtualView& view, double right_m, double convergence_m) {
    VirtualView eye = view;
    eye.width_px = view.width_px / 2;
    eye.world_from_camera.translation() += right_m * view.world_from_camera.linear().col(0);
    // What is at the convergence distance stays where the view's own camera has it.
    eye.K(0, 2) += view.K(0, 0) * right_m / convergence_m;
    // Half as many columns, twice as wide: pixel centres are at integers.
    eye.K.row(0) *= 0.5;
    eye.K(0, 2) -= 0.25;
    return eye;
}

}  // namespace

Stereoscopy Stereoscopy::settled(const VirtualView& view, double focus_m) const {
    if (view.width_px % 2 != 0)
        fail("a side-by-side picture holds two halves of one width; {} px is odd, take {} or {}",
             view.width_px, view.width_px - 1, view.width_px + 1);
    Stereoscopy whole = *this;
    if (whole.convergence_m == 0) whole.convergence_m = focus_m;
    if (!(whole.convergence_m > 0))
        fail(
            "no rig shows what the virtual camera looks at, so that the convergence distance is "
            "unknown; give it with --convergence-m");
    if (whole.interaxial_m == 0)
        whole.interaxial_m =
            far_parallax_widths * whole.convergence_m * view.width_px / view.K(0, 0);
    return whole;
}

nlohmann::ordered_json to_json(const Stereoscopy& settled) {
    return {{"layout", "side-by-side"},
            {"interaxial_m", settled.interaxial_m},
            {"convergence_m", settled.convergence_m}};
}

EyeViews eye_views(const VirtualView& view, const Stereoscopy& settled) {
    assert(view.width_px % 2 == 0 && settled.convergence_m > 0);
    return {eye(view, -0.5 * settled.interaxial_m, settled.convergence_m),
            eye(view, 0.5 * settled.interaxial_m, settled.convergence_m)};
}

double typical_depth_m(std::span<const DepthView> views, const VirtualView& target) {
    const Pose target_from_world = target.world_from_camera.inverse();
    std::vector<double> depths_m;
    for (const DepthView& view : views)
        for (const Eigen::Vector3d& world : surface_samples(view).points_m) {
            const Eigen::Vector3d point = target_from_world * world;
            if (point.z() <= 0) continue;
            const Eigen::Vector3d pixel = target.K * point / point.z();
            if (pixel.x() < 0 || pixel.x() >= target.width_px || pixel.y() < 0 ||
                pixel.y() >= target.height_px)
                continue;
            depths_m.push_back(point.z());
        }
    if (depths_m.empty()) return 0;
    const auto middle = depths_m.begin() + static_cast<std::ptrdiff_t>(depths_m.size() / 2);
    std::nth_element(depths_m.begin(), middle, depths_m.end());
    return *middle;
}

void SideBySide::put(const Texture& eye, int x_px) const {
    assert(2 * eye.width_px() == picture_.texture().width_px() &&
           eye.height_px() == picture_.texture().height_px());
    const Framebuffer source({&eye});
    glBindFramebuffer(GL_READ_FRAMEBUFFER, source.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, picture_.target().name());
    glBlitFramebuffer(0, 0, eye.width_px(), eye.height_px(), x_px, 0, x_px + eye.width_px(),
                      eye.height_px(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace vantage
