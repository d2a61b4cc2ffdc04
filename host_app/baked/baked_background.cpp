#include "host_app/baked/baked_background.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "host_app/baked/depth_tiles.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Parallax by which a tile may be wrong in the views that a probe is for.
constexpr double tile_error_px = 0.6;
/// Pixels of a probe for each cell of its backdrop.
constexpr int backdrop_cell_px = 12;
/// Pixels of a probe for each pixel of a rig, as far as the largest side allows.
constexpr double finer = 1.25;
constexpr int largest_side_px = 800;
/// Width of a probe's field relative to a rig's.
constexpr double wider = 1.15;

DepthImage inverse_of(const DepthImage& depth_m) {
    DepthImage inverse(depth_m.size(), 0.0f);
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x)
            if (depth_m(y, x) > 0) inverse(y, x) = 1 / depth_m(y, x);
    return inverse;
}

/// The depth of those pixels whose place was seen.
DepthImage seen_part(const ColourImage& colour, const DepthImage& depth_m) {
    DepthImage seen = depth_m.clone();
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x)
            if (colour(y, x)[3] < 128) seen(y, x) = 0;
    return seen;
}

BackgroundProbe::Part part_of(std::size_t first, std::size_t tiles, const ColourImage& colour,
                              const DepthImage& inverse, float cell_px, bool is_guessed) {
    BackgroundProbe::Part part{
        first,
        tiles,
        Texture(TextureFormat::rgba8, colour.cols, colour.rows, Filter::linear),
        Texture(TextureFormat::r32f, inverse.cols, inverse.rows),
        cell_px,
        is_guessed};
    part.colour.upload(colour);
    part.inverse_depth.upload(inverse);
    return part;
}

}  // namespace

BackgroundProbe::BackgroundProbe(const VirtualView& view, const ColourImage& colour,
                                 const DepthImage& depth_m, double parallax_px_m)
    : view_(view) {
    const DepthImage seen_m = seen_part(colour, depth_m);
    std::vector<DepthTile> tiles =
        planar_tiles(seen_m, static_cast<float>(tile_error_px / std::max(parallax_px_m, 1e-3)));
    const std::size_t seen = tiles.size();
    const std::vector<DepthTile> backdrop = backdrop_tiles(depth_m, backdrop_cell_px);
    tiles.insert(tiles.end(), backdrop.begin(), backdrop.end());
    const DepthImage inverse = inverse_of(seen_m);
    parts_.push_back(part_of(0, seen, colour, inverse, 1, false));
    parts_.push_back(part_of(seen, backdrop.size(),
                             backdrop_colours(colour, depth_m, backdrop_cell_px),
                             DepthImage(1, 1, 1.0f), backdrop_cell_px, true));
    if (tiles.empty()) tiles.emplace_back();
    std::vector<std::uint32_t> indices;
    indices.reserve(6 * tiles.size());
    for (std::size_t i = 0; i < tiles.size(); ++i)
        for (const unsigned k : {0U, 2U, 1U, 1U, 2U, 3U})
            indices.push_back(4 * static_cast<std::uint32_t>(i) + k);
    vertices_.emplace(Buffer::of(std::span<const DepthTile>(tiles)));
    indices_.emplace(Buffer::of(std::span<const std::uint32_t>(indices)));
}

double largest_parallax_px_m(std::span<const VirtualView> probes) {
    // Views of a lone probe are as far from it as a person would lean.
    constexpr double least_reach_m = 0.1;
    double reach_m = least_reach_m, f_px = 0;
    for (const VirtualView& a : probes) {
        f_px = std::max(f_px, a.K(0, 0));
        double nearest_m = std::numeric_limits<double>::infinity();
        for (const VirtualView& b : probes)
            if (&a != &b)
                nearest_m = std::min(
                    nearest_m,
                    (a.world_from_camera.translation() - b.world_from_camera.translation()).norm());
        if (std::isfinite(nearest_m)) reach_m = std::max(reach_m, 0.5 * nearest_m);
    }
    return f_px * reach_m;
}

std::vector<VirtualView> probe_views(std::span<const DepthView* const> rigs) {
    std::vector<VirtualView> views;
    const auto centre = [&](std::size_t i) { return rigs[i]->world_from_camera.translation(); };
    const auto add = [&](const DepthView& rig, const Pose& world_from_camera) {
        const double scale =
            std::min(finer * wider, static_cast<double>(largest_side_px) /
                                        std::max(rig.colour.cols, rig.colour.rows));
        VirtualView view;
        view.width_px = static_cast<int>(scale * rig.colour.cols);
        view.height_px = static_cast<int>(scale * rig.colour.rows);
        view.K = scaled_intrinsics(rig.K, scale / wider, scale / wider);
        view.K(0, 2) += 0.5 * view.width_px * (1 - 1 / wider);
        view.K(1, 2) += 0.5 * view.height_px * (1 - 1 / wider);
        view.world_from_camera = world_from_camera;
        views.push_back(view);
    };
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        add(*rigs[i], rigs[i]->world_from_camera);
        for (std::size_t j = i + 1; j < rigs.size(); ++j) {
            const Eigen::Vector3d middle = 0.5 * (centre(i) + centre(j));
            const double reach_m = 0.5 * (centre(i) - centre(j)).norm();
            // Two rigs are neighbours if no third one stands between them.
            bool are_neighbours = reach_m > 0;
            for (std::size_t k = 0; k < rigs.size() && are_neighbours; ++k)
                if (k != i && k != j) are_neighbours = (centre(k) - middle).norm() > reach_m;
            if (!are_neighbours) continue;
            Pose pose = Pose::Identity();
            pose.translate(middle);
            pose.rotate(Eigen::Quaterniond(rigs[i]->world_from_camera.rotation())
                            .slerp(0.5, Eigen::Quaterniond(rigs[j]->world_from_camera.rotation())));
            add(*rigs[i], pose);
        }
    }
    return views;
}

}  // namespace vantage
