#include "host_app/baked/background_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "host_app/views/projection.h"
#include "host_app/views/tolerances.h"

namespace vantage {
namespace {

constexpr int largest_block_px = 16, smallest_block_px = 2;
/// Surfaces of one block that get tiles before it is divided.
constexpr std::size_t most_surfaces = 2;

struct TilePoint {
    float u, v, inverse_depth;
};

/// The planar tiles of one depth map, collected block by block.
class TileFit {
  public:
    TileFit(const DepthImage& depth_m, float tolerance)
        : depth_m_(depth_m), tolerance_(tolerance) {}

    void add_block(const cv::Rect& block) {
        const cv::Rect inside = block & cv::Rect({}, depth_m_.size());
        std::vector<TilePoint> points;
        for (int y = inside.y; y < inside.br().y; ++y)
            for (int x = inside.x; x < inside.br().x; ++x)
                if (const float z = depth_m_(y, x); z > 0)
                    points.push_back({static_cast<float>(x), static_cast<float>(y), 1 / z});
        if (points.empty()) return;
        const auto parts = surfaces_of(points);
        const bool may_divide = block.width > smallest_block_px;
        std::vector<DepthTile> tiles;
        bool fits = !may_divide || parts.size() <= most_surfaces;
        for (std::size_t i = 0; fits && i < parts.size(); ++i) {
            const auto tile = tile_of(parts[i], !may_divide);
            fits = tile.has_value();
            if (tile) tiles.push_back(*tile);
        }
        if (fits) {
            tiles_.insert(tiles_.end(), tiles.begin(), tiles.end());
            return;
        }
        const int half = block.width / 2;
        for (int k = 0; k < 4; ++k)
            add_block({block.x + half * (k % 2), block.y + half * (k / 2), half, half});
    }
    std::vector<DepthTile> take() { return std::move(tiles_); }

  private:
    /// Divides points by the gaps between their depths.
    static std::vector<std::span<const TilePoint>> surfaces_of(std::vector<TilePoint>& points) {
        std::sort(points.begin(), points.end(), [](const TilePoint& a, const TilePoint& b) {
            return a.inverse_depth > b.inverse_depth;
        });
        std::vector<std::span<const TilePoint>> parts;
        std::size_t first = 0;
        for (std::size_t i = 1; i <= points.size(); ++i) {
            if (i < points.size() &&
                points[i - 1].inverse_depth < points[i].inverse_depth * depth_edge_ratio)
                continue;
            parts.emplace_back(points.data() + first, i - first);
            first = i;
        }
        return parts;
    }

    /// Returns the tile of one surface; nothing if it bends by more than the tolerance, unless
    /// `always`.
    std::optional<DepthTile> tile_of(std::span<const TilePoint> points, bool always) const {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        cv::Point2f least(1e9f, 1e9f), most(-1e9f, -1e9f);
        for (const TilePoint& p : points) {
            mean += Eigen::Vector3d(p.u, p.v, p.inverse_depth);
            least = {std::min(least.x, p.u), std::min(least.y, p.v)};
            most = {std::max(most.x, p.u), std::max(most.y, p.v)};
        }
        mean /= static_cast<double>(points.size());
        Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
        Eigen::Vector2d along = Eigen::Vector2d::Zero();
        for (const TilePoint& p : points) {
            const Eigen::Vector2d off(p.u - mean.x(), p.v - mean.y());
            spread += off * off.transpose();
            along += off * (p.inverse_depth - mean.z());
        }
        // A surface one pixel wide has no slope across it.
        spread += 1e-3 * static_cast<double>(points.size()) * Eigen::Matrix2d::Identity();
        const Eigen::Vector2d slope = spread.inverse() * along;
        const auto plane = [&](float u, float v) {
            return static_cast<float>(mean.z() + slope.x() * (u - mean.x()) +
                                      slope.y() * (v - mean.y()));
        };
        float bend = 0;
        for (const TilePoint& p : points)
            bend = std::max(bend, std::abs(p.inverse_depth - plane(p.u, p.v)));
        if (bend > tolerance_ && !always) return std::nullopt;
        const auto steep = static_cast<float>(slope.cwiseAbs().sum());
        const float tolerance = std::max(tolerance_, bend) + steep;
        const auto corner = [&](float u, float v) {
            return TileCorner{u, v, plane(u, v), tolerance};
        };
        const float left = least.x - 1, right = most.x + 1, top = least.y - 1, bottom = most.y + 1;
        return DepthTile{
            {corner(left, top), corner(right, top), corner(left, bottom), corner(right, bottom)}};
    }

    const DepthImage& depth_m_;
    float tolerance_;
    std::vector<DepthTile> tiles_;
};

/// The farther inverse depth of each cell, 0 where it has none.
cv::Mat1f farther_of_cells(const DepthImage& depth_m, int cell_px) {
    cv::Mat1f cells((depth_m.rows + cell_px - 1) / cell_px, (depth_m.cols + cell_px - 1) / cell_px,
                    0.0f);
    std::vector<float> depths;
    for (int y = 0; y < cells.rows; ++y)
        for (int x = 0; x < cells.cols; ++x) {
            const cv::Rect cell =
                cv::Rect(x * cell_px, y * cell_px, cell_px, cell_px) & cv::Rect({}, depth_m.size());
            depths.clear();
            for (const float z : cv::Mat1f(depth_m(cell)))
                if (z > 0) depths.push_back(z);
            if (depths.empty()) continue;
            // Not the farthest of all, which may be a single wrong pixel.
            const auto nth = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() * 7 / 8);
            std::nth_element(depths.begin(), nth, depths.end());
            cells(y, x) = 1 / *nth;
        }
    return cells;
}

/// Continues values into the cells whose weight is 0, by pull and push.
void continue_into_holes(cv::Mat& values, cv::Mat1f& weights) {
    if (values.total() <= 1 || cv::countNonZero(weights == 0) == 0) return;
    std::vector<cv::Mat> channels;
    cv::split(values, channels);
    cv::Mat1f coarse_weights;
    const cv::Size half((values.cols + 1) / 2, (values.rows + 1) / 2);
    cv::resize(weights, coarse_weights, half, 0, 0, cv::INTER_AREA);
    for (cv::Mat& channel : channels) {
        cv::Mat coarse;
        cv::resize(channel.mul(weights), coarse, half, 0, 0, cv::INTER_AREA);
        cv::divide(coarse, cv::max(coarse_weights, 1e-6f), channel);
    }
    cv::Mat coarse;
    cv::merge(channels, coarse);
    cv::Mat1f known;
    cv::Mat(coarse_weights > 0).convertTo(known, CV_32F, 1.0 / 255);
    continue_into_holes(coarse, known);
    cv::Mat fine;
    cv::resize(coarse, fine, values.size(), 0, 0, cv::INTER_LINEAR);
    fine.copyTo(values, weights == 0);
}

}  // namespace

std::vector<DepthTile> planar_tiles(const DepthImage& depth_m, float tolerance) {
    TileFit fit(depth_m, tolerance);
    for (int y = 0; y < depth_m.rows; y += largest_block_px)
        for (int x = 0; x < depth_m.cols; x += largest_block_px)
            fit.add_block({x, y, largest_block_px, largest_block_px});
    return fit.take();
}

std::vector<DepthTile> backdrop_tiles(const DepthImage& depth_m, int cell_px) {
    cv::Mat cells = farther_of_cells(depth_m, cell_px);
    cv::Mat1f known;
    cv::Mat(cells > 0).convertTo(known, CV_32F, 1.0 / 255);
    if (cv::countNonZero(known) == 0) return {};
    continue_into_holes(cells, known);
    // A corner of four cells takes the farthest, and stays behind all of them.
    cv::Mat1f corners(cells.rows + 1, cells.cols + 1);
    for (int y = 0; y < corners.rows; ++y)
        for (int x = 0; x < corners.cols; ++x) {
            float farthest = 1e9f;
            for (int k = 0; k < 4; ++k)
                farthest =
                    std::min(farthest, cells.at<float>(std::clamp(y - k / 2, 0, cells.rows - 1),
                                                       std::clamp(x - k % 2, 0, cells.cols - 1)));
            corners(y, x) = (1 - view_edge_share) * farthest;
        }
    std::vector<DepthTile> tiles;
    const auto corner = [&](int x, int y) {
        return TileCorner{static_cast<float>(std::min(x * cell_px, depth_m.cols)) - 0.5f,
                          static_cast<float>(std::min(y * cell_px, depth_m.rows)) - 0.5f,
                          corners(y, x), 1e9f};
    };
    for (int y = 0; y < cells.rows; ++y)
        for (int x = 0; x < cells.cols; ++x)
            tiles.push_back(
                {{corner(x, y), corner(x + 1, y), corner(x, y + 1), corner(x + 1, y + 1)}});
    return tiles;
}

ColourImage backdrop_colours(const ColourImage& colour, const DepthImage& depth_m, int cell_px) {
    const cv::Mat1f farther = farther_of_cells(depth_m, cell_px);
    cv::Mat cells(farther.size(), CV_32FC4, cv::Scalar::all(0));
    cv::Mat1f known(farther.size(), 0.0f);
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x) {
            const cv::Point cell(x / cell_px, y / cell_px);
            const float z = depth_m(y, x);
            if (z <= 0 || z * farther(cell) * depth_edge_ratio < 1) continue;
            cells.at<cv::Vec4f>(cell) += cv::Vec4f(colour(y, x));
            known(cell) += 1;
        }
    for (int y = 0; y < cells.rows; ++y)
        for (int x = 0; x < cells.cols; ++x)
            if (known(y, x) > 0) {
                cells.at<cv::Vec4f>(y, x) /= known(y, x);
                known(y, x) = 1;
            }
    continue_into_holes(cells, known);
    ColourImage colours;
    cells.convertTo(colours, CV_8UC4);
    for (cv::Vec4b& pixel : colours) pixel[3] = never_seen_alpha;
    return colours;
}

namespace {

/// Parallax by which a tile may be wrong in the views that a probe is for.
constexpr double tile_error_px = 0.6;
/// Pixels of a probe for each cell of its backdrop.
constexpr int backdrop_cell_px = 16;
/// Pixels that a surface is continued by into a hole, from each side.
constexpr int widest_filled_px = 12;

DepthImage inverse_of(const DepthImage& depth_m) {
    DepthImage inverse(depth_m.size(), 0.0f);
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x)
            if (depth_m(y, x) > 0) inverse(y, x) = 1 / depth_m(y, x);
    return inverse;
}

BackgroundProbe::Part part_of(std::size_t first, std::size_t tiles, const ColourImage& colour,
                              const DepthImage& inverse, const cv::Mat4b& visibility, float cell_px,
                              bool is_guessed) {
    BackgroundProbe::Part part{
        first,
        tiles,
        Texture(TextureFormat::rgba8, colour.cols, colour.rows, Filter::linear),
        Texture(TextureFormat::r32f, inverse.cols, inverse.rows),
        Texture(TextureFormat::rgba8, visibility.cols, visibility.rows, Filter::linear),
        cell_px,
        is_guessed};
    part.colour.upload(colour);
    part.inverse_depth.upload(inverse);
    part.visibility.upload(visibility);
    return part;
}

Buffer vertices_of(const ProbeTiles& probe) { return Buffer::of(std::span(probe.tiles)); }

Buffer indices_of(const ProbeTiles& probe) {
    std::vector<std::uint32_t> indices;
    indices.reserve(6 * probe.tiles.size());
    for (std::size_t i = 0; i < probe.tiles.size(); ++i)
        for (const unsigned k : {0U, 2U, 1U, 1U, 2U, 3U})
            indices.push_back(4 * static_cast<std::uint32_t>(i) + k);
    return Buffer::of(std::span<const std::uint32_t>(indices));
}

/// Continues surfaces into the holes around them, up to `widest_filled_px` from each side. Holes
/// lie beside depth edges: of the surfaces around a pixel the farthest one is continued, and is
/// marked as never seen.
void fill_holes(ColourImage& colour, DepthImage& depth_m) {
    const cv::Rect all({}, depth_m.size());
    std::vector<cv::Point> holes;
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x)
            if (depth_m(y, x) == 0) holes.emplace_back(x, y);
    for (int step = 0; step < widest_filled_px && !holes.empty(); ++step) {
        std::vector<std::pair<cv::Point, cv::Point>> filled;  // a hole and its source
        std::erase_if(holes, [&](cv::Point hole) {
            cv::Point source = hole;
            for (const cv::Point off : {cv::Point(-1, 0), {1, 0}, {0, -1}, {0, 1}})
                if (all.contains(hole + off) && depth_m(hole + off) > depth_m(source))
                    source = hole + off;
            if (source == hole) return false;
            filled.emplace_back(hole, source);
            return true;
        });
        for (const auto& [hole, source] : filled) {
            depth_m(hole) = depth_m(source);
            colour(hole) = colour(source);
            colour(hole)[3] = never_seen_alpha;
        }
    }
}

}  // namespace

ProbeTiles probe_tiles(const VirtualView& view, const ProbeSurface& surface, double parallax_px_m) {
    DepthImage distance_m = cv::abs(surface.depth_m);
    ColourImage filled = surface.colour.clone();
    fill_holes(filled, distance_m);
    ProbeTiles probe{
        .view = view,
        .tiles = planar_tiles(distance_m,
                              static_cast<float>(tile_error_px / std::max(parallax_px_m, 1e-3))),
        .inverse_depth = inverse_of(distance_m),
        .colour = filled,
        .visibility = surface.visibility,
        .rigs = surface.rigs,
        .backdrop = backdrop_colours(filled, distance_m, backdrop_cell_px)};
    probe.surface_tiles = probe.tiles.size();
    const std::vector<DepthTile> backdrop = backdrop_tiles(distance_m, backdrop_cell_px);
    probe.tiles.insert(probe.tiles.end(), backdrop.begin(), backdrop.end());
    // A view of nothing has one tile that is never drawn: buffers are never empty.
    if (probe.tiles.empty()) probe.tiles.emplace_back();
    return probe;
}

BackgroundProbe::BackgroundProbe(const ProbeTiles& tiles)
    : view_(tiles.view),
      rigs_(tiles.rigs),
      surfaces_(part_of(0, tiles.surface_tiles, tiles.colour, tiles.inverse_depth, tiles.visibility,
                        1, false)),
      backdrop_(part_of(tiles.surface_tiles, tiles.tiles.size() - tiles.surface_tiles,
                        tiles.backdrop, DepthImage(1, 1, 1.0f), cv::Mat4b(1, 1, cv::Vec4b()),
                        backdrop_cell_px, true)),
      vertices_(vertices_of(tiles)),
      indices_(indices_of(tiles)) {}

namespace {

/// Pixels of a probe for each pixel of a rig, as far as the largest side allows.
constexpr double finer = 1.25;
constexpr int largest_side_px = 800;
/// Width of a probe's field relative to a rig's.
constexpr double wider = 1.15;
/// Share of a way along the line of sight that does not count.
constexpr double free_share = 0.8;

VirtualView probe_view(const ProbeRig& rig, const Pose& world_from_camera) {
    const double scale = std::min(finer * wider, static_cast<double>(largest_side_px) /
                                                     std::max(rig.size.width, rig.size.height));
    VirtualView view;
    view.width_px = static_cast<int>(scale * rig.size.width);
    view.height_px = static_cast<int>(scale * rig.size.height);
    view.K = scaled_intrinsics(rig.K, scale / wider, scale / wider);
    view.K(0, 2) += 0.5 * view.width_px * (1 - 1 / wider);
    view.K(1, 2) += 0.5 * view.height_px * (1 - 1 / wider);
    view.world_from_camera = world_from_camera;
    return view;
}

}  // namespace

std::vector<VirtualView> probe_views(std::span<const ProbeRig> rigs) {
    std::vector<VirtualView> views;
    const auto centre = [&](std::size_t i) { return rigs[i].world_from_camera.translation(); };
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        views.push_back(probe_view(rigs[i], rigs[i].world_from_camera));
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
            pose.rotate(Eigen::Quaterniond(rigs[i].world_from_camera.rotation())
                            .slerp(0.5, Eigen::Quaterniond(rigs[j].world_from_camera.rotation())));
            views.push_back(probe_view(rigs[i], pose));
        }
    }
    return views;
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

double way_m(const VirtualView& probe, const VirtualView& view) {
    const Eigen::Vector3d off =
        view.world_from_camera.translation() - probe.world_from_camera.translation();
    const Eigen::Vector3d ahead = view.world_from_camera.linear().col(2);
    return (off - free_share * off.dot(ahead) * ahead).norm();
}

}  // namespace vantage
