#include "host_app/baked/part_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <unordered_map>
#include <utility>

#include <meshoptimizer.h>

namespace vantage {
namespace {

/// How far decimation may move an outline, px of the depth map, and a surface, px of parallax. The
/// library averages errors over the area around, so that outlines may move by several times that.
constexpr float max_outline_px = 0.12f, max_surface_px = 0.5f;

/// Inverse depth of places as far as anything on a stage can be.
constexpr float min_inverse_m = 1e-6f;

/// The corners of a pixel, in rows.
constexpr int corners = 4;

/// Numbers the vertices of a grid of squares, one for each pixel, that are joined at their corners.
class SquareGrid {
  public:
    SquareGrid(const DepthPlanes& planes, const cv::Mat1b& selected)
        : planes_(&planes), selected_(&selected), size_(selected.size()) {
        vertex_of_.resize(static_cast<std::size_t>(size_.area()) * corners, 0);
        for (int y = 0; y <= size_.height; ++y)
            for (int x = 0; x <= size_.width; ++x) join_around(x, y);
    }

    /// (u, v, inverse depth) of each vertex.
    const std::vector<Eigen::Vector3f>& vertices() const { return vertices_; }
    std::vector<std::uint32_t> triangles() const {
        std::vector<std::uint32_t> indices;
        for (int y = 0; y < size_.height; ++y)
            for (int x = 0; x < size_.width; ++x) {
                if (!(*selected_)(y, x)) continue;
                const std::uint32_t* corner = &vertex_of_[place(x, y, 0)];
                const auto bend = [&](int a, int b) {
                    return std::abs(vertices_[corner[a]].z() - vertices_[corner[b]].z());
                };
                // The diagonal along which the surface bends less.
                const std::array<int, 6> falls{0, 1, 3, 0, 3, 2}, rises{0, 1, 2, 1, 3, 2};
                for (const int i : bend(0, 3) < bend(1, 2) ? falls : rises)
                    indices.push_back(corner[i]);
            }
        return indices;
    }

    /// Turns the steps of outlines into lines: each vertex of an outline moves towards its two
    /// neighbours there, along the surface.
    void smooth_outlines(std::span<const std::uint32_t> triangles) {
        std::unordered_map<std::uint64_t, int> edges;
        const auto key = [](std::uint64_t a, std::uint64_t b) { return a << 32 | b; };
        const auto for_edges = [&](const auto& work) {
            for (std::size_t i = 0; i < triangles.size(); i += 3)
                for (std::size_t k = 0; k < 3; ++k)
                    work(triangles[i + k], triangles[i + (k + 1) % 3]);
        };
        for_edges([&](std::uint32_t a, std::uint32_t b) { ++edges[key(a, b)]; });
        struct Outline {
            Eigen::Vector2f sum = Eigen::Vector2f::Zero();
            int neighbours = 0;
        };
        std::unordered_map<std::uint32_t, Outline> outlines;
        for_edges([&](std::uint32_t a, std::uint32_t b) {
            if (edges.contains(key(b, a))) return;
            for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)}) {
                outlines[one].sum += vertices_[other].head<2>();
                ++outlines[one].neighbours;
            }
        });
        for (const auto& [at, outline] : outlines) {
            if (outline.neighbours != 2) continue;
            Eigen::Vector3f& vertex = vertices_[at];
            const Eigen::Vector2f move = 0.5f * (0.5f * outline.sum - vertex.head<2>());
            vertex.head<2>() += move;
            vertex.z() = std::max(vertex.z() + slopes_[at].dot(move), min_inverse_m);
        }
    }

  private:
    std::size_t place(int x, int y, int corner) const {
        return corners * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                          static_cast<std::size_t>(x)) +
               static_cast<std::size_t>(corner);
    }

    /// Makes the vertices of a corner of the grid: one for each surface that meets there.
    void join_around(int x, int y) {
        // The four pixels around it, in rows; the corner is their corner 3, 2, 1 and 0.
        std::array<bool, 4> is_in{};
        std::array<int, 4> group{0, 1, 2, 3};
        const auto pixel = [&](int k) { return cv::Point(x - 1 + k % 2, y - 1 + k / 2); };
        for (int k = 0; k < 4; ++k) {
            const cv::Point at = pixel(k);
            is_in[static_cast<std::size_t>(k)] =
                cv::Rect({0, 0}, size_).contains(at) && (*selected_)(at);
        }
        const auto join = [&](std::size_t a, std::size_t b, bool are_joined) {
            if (!are_joined) return;
            const int from = group[b], to = group[a];
            for (int& one : group)
                if (one == from) one = to;
        };
        const auto right = [&](int k) { return planes_->joins_right(pixel(k).x, pixel(k).y); };
        const auto down = [&](int k) { return planes_->joins_down(pixel(k).x, pixel(k).y); };
        if (is_in[0] && is_in[1]) join(0, 1, right(0));
        if (is_in[2] && is_in[3]) join(2, 3, right(2));
        if (is_in[0] && is_in[2]) join(0, 2, down(0));
        if (is_in[1] && is_in[3]) join(1, 3, down(1));
        for (int g = 0; g < 4; ++g) {
            float sum = 0, count = 0;
            Eigen::Vector2f slope = Eigen::Vector2f::Zero();
            for (int k = 0; k < 4; ++k) {
                if (!is_in[static_cast<std::size_t>(k)] || group[static_cast<std::size_t>(k)] != g)
                    continue;
                const cv::Point at = pixel(k);
                sum += planes_->inverse_at(at.x, at.y, k % 2 ? -0.5f : 0.5f, k / 2 ? -0.5f : 0.5f);
                slope += planes_->slope(at.x, at.y);
                count += 1;
                vertex_of_[place(at.x, at.y, 3 - k)] = static_cast<std::uint32_t>(vertices_.size());
            }
            if (count == 0) continue;
            vertices_.emplace_back(static_cast<float>(x) - 0.5f, static_cast<float>(y) - 0.5f,
                                   std::max(sum / count, min_inverse_m));
            slopes_.push_back(slope / count);
        }
    }

    const DepthPlanes* planes_;
    const cv::Mat1b* selected_;
    cv::Size size_;
    std::vector<std::uint32_t> vertex_of_;
    std::vector<Eigen::Vector3f> vertices_;
    std::vector<Eigen::Vector2f> slopes_;  ///< of the inverse depth
};

}  // namespace

PartMesh part_mesh(const DepthPlanes& planes, const cv::Mat1b& selected, double parallax_px) {
    SquareGrid grid(planes, selected);
    PartMesh mesh;
    const std::vector<std::uint32_t> all = grid.triangles();
    if (all.empty()) return mesh;
    grid.smooth_outlines(all);
    // In the picture's pixels and the parallax in another rig's, planes of the world are planes.
    std::vector<Eigen::Vector3f> places = grid.vertices();
    const float z_scale = static_cast<float>(parallax_px) * max_outline_px / max_surface_px;
    for (Eigen::Vector3f& place : places) place.z() *= z_scale;
    constexpr std::size_t stride = sizeof(Eigen::Vector3f);
    const float scale = meshopt_simplifyScale(places.front().data(), places.size(), stride);
    std::vector<std::uint32_t> fewer(all.size());
    fewer.resize(meshopt_simplify(fewer.data(), all.data(), all.size(), places.front().data(),
                                  places.size(), stride, 0, max_outline_px / scale, 0, nullptr));
    meshopt_optimizeVertexCache(fewer.data(), fewer.data(), fewer.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const float z = 1 / grid.vertices()[i].z();
        places[i] = {grid.vertices()[i].x() * z, grid.vertices()[i].y() * z, z};
    }
    mesh.vertices.resize(places.size());
    mesh.vertices.resize(meshopt_optimizeVertexFetch(
        mesh.vertices.data(), fewer.data(), fewer.size(), places.data(), places.size(), stride));
    mesh.indices = std::move(fewer);
    return mesh;
}

}  // namespace vantage
