#include "host_app/fused/own_picture.h"

#include <algorithm>

#include <Eigen/LU>

#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Parallax in the rig's picture up to which its picture prevails, and from which on it does not
/// count: errors of depth that are a share of the parallax stay below a pixel up to the first, and
/// beyond the second the fused picture is better (`live_truth stepped --cameras`).
constexpr float prevails_to_px = 2, counts_to_px = 12;

}  // namespace

float nearness(const DepthView& rig, double typical_depth_m, const VirtualView& view) {
    const Eigen::Vector3d away_m =
        view.world_from_camera.translation() - rig.world_from_camera.translation();
    const bool is_same_way =
        view.world_from_camera.linear().col(2).dot(rig.world_from_camera.linear().col(2)) > 0;
    if (!is_same_way || typical_depth_m <= 0) return 0;
    const double parallax_px = rig.K(0, 0) * away_m.norm() / typical_depth_m;
    return std::clamp(2 - 2 * static_cast<float>(parallax_px) / counts_to_px, 0.0f, 1.0f);
}

OwnPicture::OwnPicture(const ShaderLibrary& library)
    : colours_(library, "own_picture.frag"),
      shares_(library, "own_picture.frag", {{"SHARES", "1"}}) {}

const Texture& OwnPicture::lay_over(const Texture& picture, const Texture& depth_m,
                                    const InstantRig& near, const VirtualView& view) {
    colours_.use();
    return draw(colours_, picture_, picture, depth_m, near, view);
}

const Texture& OwnPicture::lay_over_shares(const Texture& shares, std::size_t rig,
                                           const Texture& depth_m, const InstantRig& near,
                                           const VirtualView& view) {
    Eigen::Vector4f own = Eigen::Vector4f::Zero();
    own[static_cast<Eigen::Index>(rig)] = 1;
    shares_.use().set("own_share", own);
    return draw(shares_, shared_, shares, depth_m, near, view);
}

const Texture& OwnPicture::draw(FullscreenPass& pass, DrawnTexture& into, const Texture& picture,
                                const Texture& depth_m, const InstantRig& near,
                                const VirtualView& view) {
    into.resize(picture.size());
    Program& program = pass.use();
    program.input("picture", picture);
    program.input("depth_m", depth_m);
    program.input("own", near.picture->texture());
    program.input("background_depth", near.surface->depth());
    program.input("foreground", near.boundary->colour());
    program.input("foreground_depth", near.boundary->depth());
    program.set("pixel_from_target",
                Eigen::Matrix4f(pixel_from_target_pixel(near.camera(), view).cast<float>()));
    program.set("typical_m", static_cast<float>(near.surface->median_depth_m()));
    program.set("presence",
                near.presence * nearness(near.camera(), near.surface->median_depth_m(), view));
    program.set("parallax_px", Eigen::Vector2f(prevails_to_px, counts_to_px));
    pass.overwrite(into.target());
    return into.texture();
}

}  // namespace vantage
