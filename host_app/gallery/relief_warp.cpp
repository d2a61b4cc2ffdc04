#include "host_app/gallery/relief_warp.h"

#include <algorithm>

#include "common/gl/context/limits.h"
#include "host_app/views/tolerances.h"

namespace vantage {
namespace {

/// Least distance of the plane in front of the virtual camera, relative to the typical depth.
constexpr double least_before = 0.3;

Texture stage(TextureFormat format, cv::Size size) {
    return {format, size.width, size.height,
            format == TextureFormat::rgba8 ? Filter::linear : Filter::nearest};
}

}  // namespace

ReliefWarp::Stages::Stages(cv::Size picture, cv::Size margin)
    : colour{stage(TextureFormat::rgba8, {picture.width + 2 * margin.width, picture.height}),
             stage(TextureFormat::rgba8, picture + margin + margin)},
      depth_m{stage(TextureFormat::r32f, {picture.width + 2 * margin.width, picture.height}),
              stage(TextureFormat::r32f, picture + margin + margin)} {}

ReliefWarp::ReliefWarp(const ShaderLibrary& library)
    : rows_(Program::compute(library, "relief_warp.comp")),
      columns_(Program::compute(library, "relief_warp.comp", {{"COLUMNS", "1"}})) {}

void ReliefWarp::warp(const RigSurface& surface, const VirtualView& target) {
    const cv::Size picture = surface.colour().size();
    if (!stages_ || picture != picture_) {
        picture_ = picture;
        const auto margin = [](int side_px) {
            return std::clamp((PiLimits::max_image_side_px - side_px) / 2, 0,
                              cvRound(margin_share * side_px));
        };
        margin_ = {margin(picture.width), margin(picture.height)};
        stages_.emplace(picture_, margin_);
    }
    const DepthView& camera = surface.camera();
    const Eigen::Vector3d eye =
        camera.world_from_camera.inverse() * target.world_from_camera.translation();
    const double typical_m = surface.median_depth_m();
    plane_m_ = std::max(typical_m, eye.z() + least_before * typical_m);

    const auto prepare = [&](Program& pass, int axis, int margin_px) {
        pass.use();
        pass.set("focal_px", static_cast<float>(camera.K(axis, axis)));
        pass.set("middle_px", static_cast<float>(camera.K(axis, 2)));
        pass.set("plane_m", static_cast<float>(plane_m_));
        pass.set("eye",
                 Eigen::Vector2f(static_cast<float>(eye[axis]), static_cast<float>(eye.z())));
        pass.set("margin", margin_px);
        pass.set("edge_ratio", depth_edge_ratio);
        // Rows of sensors with skew begin ever farther aside; the relief's plane has none.
        pass.set("skew_per_line",
                 axis == 0 ? static_cast<float>(camera.K(0, 1) / camera.K(1, 1)) : 0.0f);
        pass.set("skew_middle", static_cast<float>(camera.K(1, 2)));
    };
    prepare(rows_, 0, margin_.width);
    run(rows_, surface.colour(), surface.depth(), 0, picture.height);
    prepare(columns_, 1, margin_.height);
    run(columns_, stages_->colour[0], stages_->depth_m[0], 1, picture.width + 2 * margin_.width);
}

void ReliefWarp::run(Program& pass, const Texture& colour, const Texture& depth_m, int stage,
                     int lines) {
    pass.input("colour", colour);
    pass.input("depth_map", depth_m);
    glBindImageTexture(0, stages_->colour[stage].name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    glBindImageTexture(1, stages_->depth_m[stage].name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
    pass.dispatch_over(lines, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

}  // namespace vantage
