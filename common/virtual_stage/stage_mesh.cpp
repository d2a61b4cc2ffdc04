#include "common/virtual_stage/stage_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vantage {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

std::uint8_t to_byte(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
}

Vector3f position_of(const StageVertex& v) {
    return {v.position_m[0], v.position_m[1], v.position_m[2]};
}

Vector3f normal_of(const StageVertex& v) {
    const auto& n = v.normal_and_bone;
    return Vector3f(n[0], n[1], n[2]);
}

/// Two directions that form a right-handed frame with an axis.
struct Across {
    Vector3f u, v;
};
Across across(const Vector3f& axis) {
    const Vector3f helper = std::abs(axis.y()) < 0.9f ? Vector3f::UnitY() : Vector3f::UnitX();
    const Vector3f u = helper.cross(axis).normalized();
    return {u, axis.cross(u)};
}

}  // namespace

void StageMeshBuilder::begin_chunk(const ChunkKind& kind) {
    StageChunk chunk;
    chunk.first_index = static_cast<std::uint32_t>(indices_.size());
    chunk.kind = kind;
    chunks_.push_back(chunk);
    chunk_first_vertex_ = vertices_.size();
    bone_ = 0;
    placement_ = Eigen::Affine3f::Identity();
}

void StageMeshBuilder::end_chunk() {
    StageChunk& chunk = chunks_.back();
    chunk.index_count = static_cast<std::uint32_t>(indices_.size()) - chunk.first_index;
    if (chunk.index_count == 0) {
        chunks_.pop_back();
        return;
    }
    Vector3f low = Vector3f::Constant(1e9f), high = Vector3f::Constant(-1e9f);
    for (std::size_t i = chunk_first_vertex_; i < vertices_.size(); ++i) {
        low = low.cwiseMin(position_of(vertices_[i]));
        high = high.cwiseMax(position_of(vertices_[i]));
    }
    chunk.centre_m = 0.5f * (low + high);
    chunk.radius_m = 0.5f * (high - low).norm();
}

std::uint32_t StageMeshBuilder::add_vertex(const SurfacePoint& point) {
    const Vector3f position = placement_ * point.position_m;
    const Vector3f normal =
        (placement_.linear().inverse().transpose() * point.normal).normalized() * 127;
    StageVertex v{};
    v.position_m = {position.x(), position.y(), position.z()};
    v.uv = {point.uv.x(), point.uv.y()};
    for (int i = 0; i < 3; ++i)
        v.normal_and_bone[static_cast<std::size_t>(i)] =
            static_cast<std::int8_t>(std::lround(normal[i]));
    v.normal_and_bone[3] = static_cast<std::int8_t>(bone_);
    v.tint_and_layer = {to_byte(material_.tint.x()), to_byte(material_.tint.y()),
                        to_byte(material_.tint.z()),
                        static_cast<std::uint8_t>(material_.texture_layer)};
    v.gloss_mirror_glow = {to_byte(material_.gloss), to_byte(material_.mirror),
                           to_byte(material_.glow), 0};
    vertices_.push_back(v);
    return static_cast<std::uint32_t>(vertices_.size() - 1);
}

void StageMeshBuilder::patch(int columns, int rows,
                             const std::function<SurfacePoint(float, float)>& surface) {
    assert(columns > 0 && rows > 0);
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    for (int r = 0; r <= rows; ++r)
        for (int c = 0; c <= columns; ++c)
            add_vertex(surface(static_cast<float>(c) / static_cast<float>(columns),
                               static_cast<float>(r) / static_cast<float>(rows)));
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Vector3f pa = position_of(vertices_[a]);
        const Vector3f area =
            (position_of(vertices_[b]) - pa).cross(position_of(vertices_[c]) - pa);
        if (area.norm() < 1e-9f) return;
        const Vector3f facing =
            normal_of(vertices_[a]) + normal_of(vertices_[b]) + normal_of(vertices_[c]);
        if (area.dot(facing) < 0) std::swap(b, c);
        indices_.insert(indices_.end(), {a, b, c});
    };
    const auto stride = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t r = 0; r < static_cast<std::uint32_t>(rows); ++r)
        for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(columns); ++c) {
            const std::uint32_t corner = first + r * stride + c;
            triangle(corner, corner + 1, corner + stride + 1);
            triangle(corner, corner + stride + 1, corner + stride);
        }
}

void StageMeshBuilder::rectangle(const Vector3f& origin_m, const Vector3f& edge_u_m,
                                 const Vector3f& edge_v_m, bool stretched, int columns, int rows) {
    const Vector3f normal = edge_u_m.cross(edge_v_m).normalized();
    const Vector2f repeats =
        stretched ? Vector2f(1, 1)
                  : Vector2f(edge_u_m.norm(), edge_v_m.norm()) * material_.texture_per_m;
    patch(columns, rows, [&](float s, float t) {
        return SurfacePoint{origin_m + s * edge_u_m + t * edge_v_m, normal,
                            Vector2f(s * repeats.x(), (1 - t) * repeats.y())};
    });
}

void StageMeshBuilder::box(const Vector3f& centre_m, const Vector3f& size_m) {
    const Vector3f x = Vector3f::UnitX() * size_m.x(), y = Vector3f::UnitY() * size_m.y(),
                   z = Vector3f::UnitZ() * size_m.z();
    const Vector3f low = centre_m - 0.5f * size_m, high = centre_m + 0.5f * size_m;
    rectangle(low + z, x, y);       // front
    rectangle(low + x, -x, y);      // back
    rectangle(low, z, y);           // left
    rectangle(low + x + z, -z, y);  // right
    rectangle(high - x, x, -z);     // top, seen from above with -z upward
    rectangle(low, x, z);           // bottom
}

void StageMeshBuilder::ellipsoid(const Vector3f& centre_m, const Vector3f& radii_m, int around,
                                 int along) {
    const float repeats_u = std::max(1.0f, std::round(tau * radii_m.x() * material_.texture_per_m));
    const float repeats_v = 0.5f * tau * radii_m.y() * material_.texture_per_m;
    patch(around, along, [&](float s, float t) {
        const float azimuth = tau * s, polar = 0.5f * tau * t;
        const Vector3f unit(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                            std::sin(polar) * std::cos(azimuth));
        return SurfacePoint{centre_m + radii_m.cwiseProduct(unit), unit.cwiseQuotient(radii_m),
                            Vector2f(s * repeats_u, t * repeats_v)};
    });
}

void StageMeshBuilder::rod(const Vector3f& from_m, const Vector3f& to_m, float from_radius_m,
                           float to_radius_m, int sides, bool closed) {
    const Vector3f axis = (to_m - from_m).normalized();
    const float length = (to_m - from_m).norm();
    const Across side = across(axis);
    const Vector2f repeats(
        std::max(1.0f, std::round(tau * from_radius_m * material_.texture_per_m)),
        length * material_.texture_per_m);
    const float slope = (from_radius_m - to_radius_m) / length;
    const auto outward = [&](float s) -> Vector3f {
        return std::cos(tau * s) * side.u + std::sin(tau * s) * side.v;
    };
    patch(sides, 1, [&](float s, float t) {
        const float radius = from_radius_m + t * (to_radius_m - from_radius_m);
        return SurfacePoint{from_m + t * (to_m - from_m) + radius * outward(s),
                            outward(s) + slope * axis,
                            Vector2f(s * repeats.x(), (1 - t) * repeats.y())};
    });
    if (!closed) return;
    for (const bool at_end : {false, true}) {
        const Vector3f& centre = at_end ? to_m : from_m;
        const float radius = at_end ? to_radius_m : from_radius_m;
        patch(sides, 1, [&](float s, float t) {
            const Vector3f offset = t * radius * outward(s);
            return SurfacePoint{
                centre + offset, at_end ? axis : Vector3f(-axis),
                Vector2f(offset.dot(side.u), offset.dot(side.v)) * material_.texture_per_m};
        });
    }
}

void StageMeshBuilder::loft(std::span<const LoftRing> rings, int around) {
    assert(rings.size() >= 2);
    const int last = static_cast<int>(rings.size()) - 1;
    float widest = 0;
    for (const LoftRing& ring : rings) widest = std::max(widest, ring.radius_x_m);
    const float repeats_u = std::max(1.0f, std::round(tau * widest * material_.texture_per_m));
    patch(around, last, [&](float s, float t) {
        const int i = static_cast<int>(std::lround(t * static_cast<float>(last)));
        const auto at = [&](int k) { return rings[static_cast<std::size_t>(k)]; };
        const LoftRing ring = at(i), before = at(std::max(i - 1, 0)),
                       after = at(std::min(i + 1, last));
        const float c = std::cos(tau * s), n = std::sin(tau * s);
        const auto point = [&](const LoftRing& r) {
            return Vector3f(r.radius_x_m * n, r.y_m, r.centre_z_m + r.radius_z_m * c);
        };
        const Vector3f along = point(after) - point(before);
        const Vector3f tangent(std::max(ring.radius_x_m, 1e-3f) * c, 0,
                               -std::max(ring.radius_z_m, 1e-3f) * n);
        Vector3f normal = tangent.cross(along);
        if (rings.back().y_m < rings.front().y_m) normal = -normal;
        if (normal.norm() < 1e-9f) normal = Vector3f(n, 0, c);
        return SurfacePoint{point(ring), normal,
                            Vector2f(s * repeats_u, -ring.y_m * material_.texture_per_m)};
    });
}

void StageMeshBuilder::ring(const Vector3f& centre_m, float inner_radius_m, float outer_radius_m,
                            int around, int outward, bool stretched) {
    patch(around, outward, [&](float s, float t) {
        const float radius = inner_radius_m + t * (outer_radius_m - inner_radius_m);
        const Vector3f offset(radius * std::sin(tau * s), 0, radius * std::cos(tau * s));
        const Vector2f flat(offset.x(), offset.z());
        return SurfacePoint{centre_m + offset, Vector3f::UnitY(),
                            stretched
                                ? Vector2f(0.5f * flat / outer_radius_m + Vector2f(0.5f, 0.5f))
                                : Vector2f(flat * material_.texture_per_m)};
    });
}

void StageMeshBuilder::torus(const Vector3f& centre_m, float ring_radius_m, float tube_radius_m,
                             int around, int sides) {
    const Vector2f repeats(
        std::max(1.0f, std::round(tau * ring_radius_m * material_.texture_per_m)), 1);
    patch(around, sides, [&](float s, float t) {
        const Vector3f out(std::sin(tau * s), 0, std::cos(tau * s));
        const Vector3f normal = std::cos(tau * t) * out + std::sin(tau * t) * Vector3f::UnitY();
        return SurfacePoint{centre_m + ring_radius_m * out + tube_radius_m * normal, normal,
                            Vector2f(s * repeats.x(), t * repeats.y())};
    });
}

void StageMeshBuilder::truss(const Vector3f& from_m, const Vector3f& to_m, float width_m,
                             float chord_radius_m, int bays) {
    const auto [u, v] = across((to_m - from_m).normalized());
    const float h = 0.5f * width_m;
    const std::array<Vector3f, 4> corners = {Vector3f(h * u + h * v), Vector3f(-h * u + h * v),
                                             Vector3f(-h * u - h * v), Vector3f(h * u - h * v)};
    for (const Vector3f& corner : corners)
        rod(from_m + corner, to_m + corner, chord_radius_m, chord_radius_m, 6, false);
    for (int i = 0; i < bays; ++i) {
        const auto at = [&](int k) -> Vector3f {
            return from_m + (to_m - from_m) * (static_cast<float>(k) / static_cast<float>(bays));
        };
        for (std::size_t side = 0; side < 4; ++side) {
            const std::size_t a = (side + static_cast<std::size_t>(i)) % 2 ? side : (side + 1) % 4;
            const std::size_t b = a == side ? (side + 1) % 4 : side;
            rod(at(i) + corners[a], at(i + 1) + corners[b], 0.6f * chord_radius_m,
                0.6f * chord_radius_m, 4, false);
        }
    }
}

}  // namespace vantage
