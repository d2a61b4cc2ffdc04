#include "host_app/synthesis/stereoscopy.h"

#include <algorithm>
#include <array>
#include <cassert>

#include <fmt/format.h>

#include "common/base/error.h"
#include "host_app/views/depth_view.h"

namespace vantage {
namespace {

/// Default parallax of infinitely far points, in picture widths: see Stereoscopy::interaxial_m.
constexpr double far_parallax_widths = 0.02, quilt_parallax_widths = 0.08;

bool is_whole(StereoLayout layout) { return layout == StereoLayout::anaglyph; }

VirtualView eye(const VirtualView& view, double right_m, double convergence_m) {
    VirtualView eye = view;
    eye.world_from_camera.translation() += right_m * view.world_from_camera.linear().col(0);
    // Points at the convergence distance stay where the view's own camera shows them.
    eye.K(0, 2) += view.K(0, 0) * right_m / convergence_m;
    return eye;
}

/// Divides the view's size by `by`; its first pixel then lies `first_px` into the old image.
void shrink(VirtualView& view, cv::Size by, const Eigen::Vector2d& first_px) {
    view.width_px /= by.width;
    view.height_px /= by.height;
    for (const int axis : {0, 1}) {
        view.K(axis, 2) -= first_px[axis];
        view.K.row(axis) /= axis == 0 ? by.width : by.height;
    }
}

void copy(const Texture& eye, const Framebuffer& target, cv::Point at) {
    const Framebuffer source({&eye});
    glBindFramebuffer(GL_READ_FRAMEBUFFER, source.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.name());
    glBlitFramebuffer(0, 0, eye.width_px(), eye.height_px(), at.x, at.y, at.x + eye.width_px(),
                      at.y + eye.height_px(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace

std::span<const std::string> stereo_layout_names() {
    static const std::array<std::string, 5> names{"side-by-side", "top-and-bottom",
                                                  "interleaved-rows", "anaglyph", "quilt"};
    return names;
}

cv::Size Stereoscopy::tiles() const {
    switch (layout) {
        case StereoLayout::side_by_side:
            return {2, 1};
        case StereoLayout::top_and_bottom:
        case StereoLayout::interleaved_rows:
            return {1, 2};
        case StereoLayout::anaglyph:
            return {1, 1};
        case StereoLayout::quilt:
            return quilt;
    }
    return {1, 1};
}

std::size_t Stereoscopy::eyes() const {
    return layout == StereoLayout::quilt ? static_cast<std::size_t>(quilt.area()) : 2;
}

cv::Size Stereoscopy::rendered_size(cv::Size full, double scale) const {
    if (layout == StereoLayout::interleaved_rows) return full;
    const cv::Size by = tiles();
    return {by.width * std::max(1, cvRound(full.width * scale / by.width)),
            by.height * std::max(1, cvRound(full.height * scale / by.height))};
}

Stereoscopy Stereoscopy::settled(const VirtualView& view, double focus_m) const {
    const auto require_parts = [&](const char* of, int px, int parts) {
        if (px % parts == 0) return;
        const int less = px - px % parts;
        fail("a {} picture's {} is {} equal parts; {} px is not, take {} or {}",
             stereo_layout_names()[static_cast<std::size_t>(layout)], of, parts, px, less,
             less + parts);
    };
    require_parts("width", view.width_px, tiles().width);
    require_parts("height", view.height_px, tiles().height);
    Stereoscopy whole = *this;
    if (whole.convergence_m == 0) whole.convergence_m = focus_m;
    if (!(whole.convergence_m > 0))
        fail(
            "no rig shows what the virtual camera looks at, so that the convergence distance is "
            "unknown; give it with --convergence-m");
    if (whole.interaxial_m == 0)
        whole.interaxial_m =
            (layout == StereoLayout::quilt ? quilt_parallax_widths : far_parallax_widths) *
            whole.convergence_m * view.width_px / view.K(0, 0);
    return whole;
}

nlohmann::ordered_json to_json(const Stereoscopy& settled) {
    nlohmann::ordered_json json{
        {"layout", stereo_layout_names()[static_cast<std::size_t>(settled.layout)]},
        {"interaxial_m", settled.interaxial_m},
        {"convergence_m", settled.convergence_m}};
    if (settled.layout == StereoLayout::quilt)
        json["quilt"] = fmt::format("{}x{}", settled.quilt.width, settled.quilt.height);
    return json;
}

std::vector<VirtualView> eye_views(const VirtualView& view, const Stereoscopy& settled) {
    assert(settled.convergence_m > 0 && settled.eyes() >= 2);
    std::vector<VirtualView> eyes;
    const cv::Size by = settled.tiles();
    for (std::size_t i = 0; i < settled.eyes(); ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(settled.eyes() - 1) - 0.5;
        eyes.push_back(eye(view, share * settled.interaxial_m, settled.convergence_m));
        // A pixel's centre is the mean of those it covers; interleaved rows belong to one eye each.
        const Eigen::Vector2d first_px =
            settled.layout == StereoLayout::interleaved_rows
                ? Eigen::Vector2d(0, static_cast<double>(i))
                : Eigen::Vector2d(0.5 * (by.width - 1), 0.5 * (by.height - 1));
        shrink(eyes.back(), by, first_px);
    }
    return eyes;
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

void EyeMosaic::begin(cv::Size size, const Stereoscopy& settled) {
    settled_ = settled;
    picture_.resize(size);
}

void EyeMosaic::put(const Texture& eye, std::size_t number) {
    const cv::Size by = settled_.tiles();
    const auto place = static_cast<int>(number);
    switch (settled_.layout) {
        case StereoLayout::side_by_side:
        case StereoLayout::top_and_bottom:
            copy(eye, picture_.target(),
                 {place * (by.width - 1) * eye.width_px(),
                  place * (by.height - 1) * eye.height_px()});
            return;
        case StereoLayout::quilt:
            // Quilts begin with the leftmost view at the lower left.
            copy(eye, picture_.target(),
                 {place % by.width * eye.width_px(),
                  (by.height - 1 - place / by.width) * eye.height_px()});
            return;
        case StereoLayout::interleaved_rows:
        case StereoLayout::anaglyph: {
            DrawnTexture& kept = number == 0 ? left_ : right_;
            kept.resize(eye.size());
            copy(eye, kept.target(), {0, 0});
            return;
        }
    }
}

const Texture& EyeMosaic::picture() {
    if (settled_.layout == StereoLayout::interleaved_rows || is_whole(settled_.layout)) {
        const bool rows = !is_whole(settled_.layout);
        std::optional<FullscreenPass>& pass = rows ? rows_ : anaglyph_;
        if (!pass) pass.emplace(*library_, rows ? "eyes_rows.frag" : "eyes_anaglyph.frag");
        Program& program = pass->use();
        program.input("left", left_.texture());
        program.input("right", right_.texture());
        pass->draw(picture_.target());
    }
    return picture_.texture();
}

}  // namespace vantage
