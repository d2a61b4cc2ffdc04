#include "host_app/fused/own_picture.h"

#include <algorithm>
#include <limits>
#include <utility>

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

std::optional<NearRig> near_rig(std::span<const InstantRig* const> rigs, const VirtualView& view) {
    double nearest_m = std::numeric_limits<double>::infinity(), next_m = nearest_m;
    NearRig near;
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        const double away_m = (rigs[i]->camera().world_from_camera.translation() -
                               view.world_from_camera.translation())
                                  .norm();
        if (away_m < nearest_m) {
            next_m = std::exchange(nearest_m, away_m);
            near.rig = i;
        } else {
            next_m = std::min(next_m, away_m);
        }
    }
    if (nearest_m >= next_m || !rigs[near.rig]->picture) return std::nullopt;
    const InstantRig& rig = *rigs[near.rig];
    // The weight is 1 where the next rig is at least three times as far away, and 0 where it is as
    // near.
    const double alone = std::clamp(1.5 - 1.5 * nearest_m / next_m, 0.0, 1.0);
    near.weight = static_cast<float>(alone) * rig.presence *
                  nearness(rig.camera(), rig.surface->median_depth_m(), view);
    if (near.weight <= 0) return std::nullopt;
    return near;
}

OwnPicture::OwnPicture(const ShaderLibrary& library)
    : colours_(library, "own_picture.frag"),
      shares_(library, "own_picture.frag", {{"SHARES", "1"}}) {}

const Texture& OwnPicture::lay_over(const Texture& picture, const Texture& depth_m,
                                    const NearRig& near, std::span<const InstantRig* const> rigs,
                                    const VirtualView& view) {
    return draw(colours_, picture_, picture, depth_m, *rigs[near.rig], near.weight, view);
}

const Texture& OwnPicture::lay_over_shares(const Texture& shares, const Texture& depth_m,
                                           const NearRig& near,
                                           std::span<const InstantRig* const> rigs,
                                           const VirtualView& view) {
    Eigen::Vector4f own = Eigen::Vector4f::Zero();
    own[static_cast<Eigen::Index>(near.rig)] = 1;
    shares_.use().set("own_share", own);
    return draw(shares_, shared_, shares, depth_m, *rigs[near.rig], near.weight, view);
}

const Texture& OwnPicture::draw(FullscreenPass& pass, DrawnTexture& into, const Texture& picture,
                                const Texture& depth_m, const InstantRig& near, float weight,
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
    program.set("rig_weight", weight);
    program.set("parallax_px", Eigen::Vector2f(prevails_to_px, counts_to_px));
    pass.overwrite(into.target());
    return into.texture();
}

}  // namespace vantage
