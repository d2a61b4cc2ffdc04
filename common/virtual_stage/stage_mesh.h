#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace vantage {

/// Look of a surface. Tints and textures are display-coded colours; the shader decodes them.
struct StageMaterial {
    int texture_layer = 0;  ///< of StageTextures
    Eigen::Vector3f tint = Eigen::Vector3f::Ones();
    float texture_per_m = 0.5f;  ///< how often the texture repeats along a metre of surface
    float gloss = 0;   ///< 0..1, strength of the view-dependent highlight; glossy chunks only
    float mirror = 0;  ///< 0..1, share of the reflected surroundings; glossy chunks only
    float glow = 0;    ///< 0..1, light of its own
};

/// As the GPU reads it: 32 bytes.
struct StageVertex {
    std::array<float, 3> position_m;
    std::array<float, 2> uv;
    std::array<std::int8_t, 4> normal_and_bone;  ///< normal * 127, then the bone's number
    std::array<std::uint8_t, 4> tint_and_layer;
    std::array<std::uint8_t, 4> gloss_mirror_glow;
};

/// Where the key light's shadow is looked up: at every pixel of a surface, at the vertices of
/// finely meshed ones, or nowhere, out of the key light's reach.
enum class ShadowLookup { none, vertex, pixel };

/// How a chunk is drawn.
struct ChunkKind {
    ShadowLookup shadow = ShadowLookup::pixel;
    bool casts_shadow = true;
    bool glossy = false;
    bool animated = false;
};

/// A run of triangles drawn, culled and lit together.
struct StageChunk {
    std::uint32_t first_index = 0, index_count = 0;
    Eigen::Vector3f centre_m = Eigen::Vector3f::Zero();  ///< of a sphere around it, for culling
    float radius_m = 0;
    ChunkKind kind;
};

/// Scenery that neither casts a shadow on the stage nor gets one.
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

/// Puts triangle meshes together from shapes. Every shape is placed by the current transform,
/// looks like the current material and hangs on the current bone. All surfaces face outward.
class StageMeshBuilder {
  public:
    void begin_chunk(const ChunkKind& kind = {});
    void end_chunk();

    void set_material(const StageMaterial& material) { material_ = material; }
    void set_placement(const Eigen::Affine3f& world_from_local) { placement_ = world_from_local; }
    void set_bone(int bone) { bone_ = bone; }

    /// (columns + 1) x (rows + 1) points over (s, t) in [0, 1] x [0, 1]. Triangles face the side
    /// the normals point to; those without area are left out.
    void patch(int columns, int rows, const std::function<SurfacePoint(float s, float t)>& surface);

    /// A rectangle with the corner `origin` and normal edge_u x edge_v. uv in repeats, or once over
    /// the rectangle where `stretched`; v grows against edge_v, so that pictures stand upright.
    void rectangle(const Eigen::Vector3f& origin_m, const Eigen::Vector3f& edge_u_m,
                   const Eigen::Vector3f& edge_v_m, bool stretched = false, int columns = 1,
                   int rows = 1);
    void box(const Eigen::Vector3f& centre_m, const Eigen::Vector3f& size_m);
    void ellipsoid(const Eigen::Vector3f& centre_m, const Eigen::Vector3f& radii_m, int around,
                   int along);
    /// A frustum of a cone with closed ends; the same radii make a cylinder.
    void rod(const Eigen::Vector3f& from_m, const Eigen::Vector3f& to_m, float from_radius_m,
             float to_radius_m, int sides, bool closed = true);
    /// A skin over elliptical rings from the first to the last, with round normals.
    void loft(std::span<const LoftRing> rings, int around);
    /// Flat, in the plane y = height, facing up.
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

}  // namespace vantage
