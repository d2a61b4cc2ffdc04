#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace vantage {

/// The look of a surface. Tints and textures are display-coded colours; the shader decodes them.
struct StageMaterial {
    int texture_layer = 0;  ///< of StageTextures
    Eigen::Vector3f tint = Eigen::Vector3f::Ones();
    float texture_per_m = 0.5f;  ///< repeats of the texture per metre of surface
    float gloss = 0;   ///< 0..1, strength of the view-dependent highlight; glossy chunks only
    float mirror = 0;  ///< 0..1, share of the reflected surroundings; glossy chunks only
    float glow = 0;    ///< 0..1, emitted light
};

/// A vertex in the GPU's layout: 32 bytes.
struct StageVertex {
    std::array<float, 3> position_m;
    std::array<float, 2> uv;
    std::array<std::int8_t, 4> normal_and_bone;  ///< normal * 127, then the bone's number
    std::array<std::uint8_t, 4> tint_and_layer;
    std::array<std::uint8_t, 4> gloss_mirror_glow;
};

/// Where the key light's shadow is looked up: at every pixel of a surface, at the vertices of
/// finely meshed surfaces, or nowhere, beyond the reach of the key light.
enum class ShadowLookup { none, vertex, pixel };

/// The shader variant of a chunk.
struct ChunkKind {
    ShadowLookup shadow = ShadowLookup::pixel;
    bool casts_shadow = true;
    bool glossy = false;
    bool animated = false;
};

/// A range of triangles that are drawn, culled and lit together.
struct StageChunk {
    std::uint32_t first_index = 0, index_count = 0;
    Eigen::Vector3f centre_m = Eigen::Vector3f::Zero();  ///< of its bounding sphere, for culling
    float radius_m = 0;
    ChunkKind kind;
};

/// Scenery that neither casts nor receives shadows.
inline constexpr ChunkKind far_scenery{.shadow = ShadowLookup::none, .casts_shadow = false};

/// One point of a parametric surface; uv in repeats of the texture.
struct SurfacePoint {
    Eigen::Vector3f position_m, normal;
    Eigen::Vector2f uv;
};

/// One elliptical cross section of a loft along y.
struct LoftRing {
    float y_m, radius_x_m, radius_z_m, centre_z_m = 0;
};

/// Builds triangle meshes from shapes. Every shape gets the current transform, material and bone.
/// All surfaces face outward.
class StageMeshBuilder {
  public:
    void begin_chunk(const ChunkKind& kind = {});
    void end_chunk();

    void set_material(const StageMaterial& material) { material_ = material; }
    void set_placement(const Eigen::Affine3f& world_from_local) { placement_ = world_from_local; }
    void set_bone(int bone) { bone_ = bone; }

    /// A grid of (columns + 1) x (rows + 1) points over (s, t) in [0, 1] x [0, 1]. Triangles face
    /// the side of the normals; triangles without area are skipped.
    void patch(int columns, int rows, const std::function<SurfacePoint(float s, float t)>& surface);

    /// A rectangle with the corner `origin` and normal edge_u x edge_v. uv in repeats, or once over
    /// the rectangle if `stretched`; v grows against edge_v, so that images are upright.
    void rectangle(const Eigen::Vector3f& origin_m, const Eigen::Vector3f& edge_u_m,
                   const Eigen::Vector3f& edge_v_m, bool stretched = false, int columns = 1,
                   int rows = 1);
    void box(const Eigen::Vector3f& centre_m, const Eigen::Vector3f& size_m);
    void ellipsoid(const Eigen::Vector3f& centre_m, const Eigen::Vector3f& radii_m, int around,
                   int along);
    /// A cone frustum with closed ends; equal radii make a cylinder.
    void rod(const Eigen::Vector3f& from_m, const Eigen::Vector3f& to_m, float from_radius_m,
             float to_radius_m, int sides, bool closed = true);
    /// A closed surface over elliptical rings from the first to the last, with smooth normals.
    void loft(std::span<const LoftRing> rings, int around);
    /// A flat ring in the plane y = height, facing up.
    void ring(const Eigen::Vector3f& centre_m, float inner_radius_m, float outer_radius_m,
              int around, int outward, bool stretched = false);
    void torus(const Eigen::Vector3f& centre_m, float ring_radius_m, float tube_radius_m,
               int around, int sides);
    /// A lattice beam: four chords and zigzag webs.
    void truss(const Eigen::Vector3f& from_m, const Eigen::Vector3f& to_m, float width_m,
               float chord_radius_m, int bays);

    const std::vector<StageVertex>& vertices() const { return vertices_; }
    const std::vector<std::uint32_t>& indices() const { return indices_; }
    const std::vector<StageChunk>& chunks() const { return chunks_; }

  private:
    std::uint32_t add_vertex(const SurfacePoint& point);

    StageMaterial material_;
    Eigen::Affine3f placement_ = Eigen::Affine3f::Identity();
    int bone_ = 0;
    std::vector<StageVertex> vertices_;
    std::vector<std::uint32_t> indices_;
    std::vector<StageChunk> chunks_;
    std::size_t chunk_first_vertex_ = 0;
};

/// A whole turn in radians.
inline constexpr float tau = 2 * std::numbers::pi_v<float>;

}  // namespace vantage
