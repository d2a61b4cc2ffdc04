#include "common/virtual_stage/virtual_stage.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/gl/context/limits.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"
#include "common/virtual_stage/stage_bounds.h"
#include "common/virtual_stage/stage_projection.h"
#include "common/virtual_stage/stage_scene.h"
#include "common/virtual_stage/stage_targets.h"
#include "common/virtual_stage/stage_textures.h"

namespace vantage {
namespace {

constexpr double near_m = 0.1, far_m = 100;
constexpr int max_bones = 40;
constexpr int shadow_side_px = 1024;
constexpr float shadow_half_size_m = 4.2f;
constexpr std::size_t max_kept_targets = 4, max_kept_scenes = 4;
/// The reach of a shadow beyond its edge: shadow map look-ups are offset from the surface and lie
/// between texels.
constexpr float shadow_margin_m = 0.05f;

/// Sets the GL state for drawing solids; called before every pass.
void prepare_to_draw_solids() {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_CULL_FACE);
    // Row 0 at the top flips the image, and with it the winding of front faces.
    glFrontFace(GL_CW);
}

/// Restores framebuffer and viewport, and sets the rest to GL's defaults.
class StateGuard {
  public:
    StateGuard() {
        glGetIntegerv(GL_FRAMEBUFFER_BINDING, &framebuffer_);
        glGetIntegerv(GL_VIEWPORT, viewport_);
    }
    ~StateGuard() {
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_CULL_FACE);
        glFrontFace(GL_CCW);
        glBindVertexArray(0);
        glActiveTexture(GL_TEXTURE0);
        glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
        glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    }
    StateGuard(const StateGuard&) = delete;
    StateGuard& operator=(const StateGuard&) = delete;

  private:
    GLint framebuffer_ = 0;
    GLint viewport_[4] = {};
};

bool are_same(const StageCamera& a, const StageCamera& b) {
    return a.width_px == b.width_px && a.height_px == b.height_px && a.K == b.K &&
           a.world_from_camera.matrix() == b.world_from_camera.matrix();
}

/// A camera's image of the scene, without performers (`still`) and with them (`moving`).
struct KeptScene {
    KeptScene(const StageCamera& from, int samples_per_side)
        : camera(from),
          still({from.width_px, from.height_px}, samples_per_side),
          moving({from.width_px, from.height_px}, samples_per_side),
          differing({from.width_px, from.height_px}) {
        differing.add(cv::Rect(0, 0, from.width_px, from.height_px));
    }

    StageCamera camera;
    StageTargets still, moving;
    std::vector<cv::Rect> seen;  ///< per triangle that performers may shade: its place, or empty
    PictureParts differing;      ///< where the colour of `moving` differs from `still`
    bool has_colour = false, has_depth = false;
};

/// A triangle of the scenery that receives shadows.
struct Triangle {
    const StageChunk* chunk;
    std::size_t first_index;
    std::array<Eigen::Vector3f, 3> corners_m;
    cv::Rect in_shadow_map;  ///< in texels
};

/// The shader program of one chunk kind.
struct ColourProgram {
    ShadowLookup shadow;
    bool glossy;
    Program program;
};

/// The scenery's textures as the layers of one.
struct LayeredTexture {
    GlHandle<delete_texture> handle;

    void bind(int unit) const {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(GL_TEXTURE_2D_ARRAY, handle.name());
    }
};

LayeredTexture upload_textures(std::uint64_t seed) {
    GLuint name = 0;
    glGenTextures(1, &name);
    GlHandle<delete_texture> handle(name);
    glBindTexture(GL_TEXTURE_2D_ARRAY, name);
    const int levels = static_cast<int>(std::log2(stage_texture_side_px)) + 1;
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, levels, GL_RGBA8, stage_texture_side_px,
                   stage_texture_side_px, stage_texture_count);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    GLint layer = 0;
    for (const ColourImage& image : draw_stage_textures(seed))
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer++, image.cols, image.rows, 1, GL_RGBA,
                        GL_UNSIGNED_BYTE, image.data);
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
    // A nearest mip level: the steps between levels vanish within the samples of a pixel, and it is
    // far cheaper than blending levels.
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
    check_gl("loading the virtual stage's textures");
    return {std::move(handle)};
}

Texture make_shadow_texture(bool compared) {
    Texture texture(TextureFormat::depth24, shadow_side_px, shadow_side_px,
                    compared ? Filter::linear : Filter::nearest);
    if (compared) {
        glBindTexture(GL_TEXTURE_2D, texture.name());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    }
    return texture;
}

/// GL takes offsets into the bound buffer as pointers.
const void* as_offset(std::size_t bytes) {
    return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
}

VertexArray make_vertex_array(const Buffer& vertices, const Buffer& indices) {
    VertexArray array;
    array.bind();
    vertices.bind(GL_ARRAY_BUFFER);
    indices.bind(GL_ELEMENT_ARRAY_BUFFER);
    constexpr GLsizei stride = sizeof(StageVertex);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride,
                          as_offset(offsetof(StageVertex, position_m)));
    glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, as_offset(offsetof(StageVertex, uv)));
    glVertexAttribIPointer(2, 4, GL_BYTE, stride,
                           as_offset(offsetof(StageVertex, normal_and_bone)));
    glVertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                          as_offset(offsetof(StageVertex, tint_and_layer)));
    glVertexAttribPointer(4, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                          as_offset(offsetof(StageVertex, gloss_mirror_glow)));
    for (GLuint attribute = 0; attribute < 5; ++attribute) glEnableVertexAttribArray(attribute);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    return array;
}

void validate(const StageCamera& camera) {
    if (!camera.K.allFinite() || !(camera.K(0, 0) > 0) || !(camera.K(1, 1) > 0) ||
        camera.K(2, 0) != 0 || camera.K(2, 1) != 0 || camera.K(2, 2) != 1)
        fail(
            "the virtual camera's K needs focal lengths above 0 and the last row 0 0 1, but has "
            "fx {} and fy {}",
            camera.K(0, 0), camera.K(1, 1));
    if (!camera.world_from_camera.matrix().allFinite())
        fail("the virtual camera's pose is not finite");
}

}  // namespace

struct VirtualStage::Impl {
    Impl(const ShaderLibrary& library, StageScene made)
        : scene(std::move(made)),
          vertices(Buffer::of(std::span(scene.mesh.vertices()))),
          indices(Buffer::of(std::span(scene.mesh.indices()))),
          vertex_array(make_vertex_array(vertices, indices)),
          textures(upload_textures(scene.texture_seed)),
          still_shadow(make_shadow_texture(false)),
          shadow(make_shadow_texture(true)),
          still_shadow_target({}, &still_shadow),
          shadow_target({}, &shadow),
          colour_programs(make_colour_programs(library)),
          depth_program(
              Program::render(library, "stage_depth.vert", "stage_depth.frag", {bones_define()})),
          shadow_program(
              Program::render(library, "stage_depth.vert", "stage_shadow.frag", {bones_define()})),
          reduce(library, "stage_reduce.frag",
                 {{"POINT_SPREAD_PX", fmt::format("{}", point_spread_px)}}),
          shadow_from_world(clip_from_world_parallel(scene.lighting.key_direction, {0, 1, 0},
                                                     shadow_half_size_m)),
          bone_rows(3 * (1 + scene.performers.size() * bones_of_performer)),
          vertices_of_bone(bone_rows.size() / 3),
          points_m_of_bone(vertices_of_bone.size()) {
        assert(bone_rows.size() <= std::size_t{3} * max_bones);
        set_bone(0, Eigen::Affine3f::Identity());
        for (const StageVertex& v : scene.mesh.vertices())
            if (v.normal_and_bone[3] > 0)
                vertices_of_bone[static_cast<std::size_t>(v.normal_and_bone[3])].emplace_back(
                    v.position_m[0], v.position_m[1], v.position_m[2]);
        const StateGuard guard;
        still_shadow_target.bind();
        glClear(GL_DEPTH_BUFFER_BIT);
        draw_shadows(false);
        find_shadeable();
    }

    /// The programs in drawing order: near and small chunks before far and large ones.
    static std::vector<ColourProgram> make_colour_programs(const ShaderLibrary& library) {
        std::vector<ColourProgram> programs;
        for (const ShadowLookup shadow :
             {ShadowLookup::vertex, ShadowLookup::pixel, ShadowLookup::none})
            for (const bool glossy : {true, false})
                programs.push_back(
                    {shadow, glossy,
                     Program::render(library, "stage_colour.vert", "stage_colour.frag",
                                     {bones_define(),
                                      {"SHADOW", std::to_string(static_cast<int>(shadow))},
                                      {"GLOSSY", glossy ? "1" : "0"}})});
        return programs;
    }

    static std::pair<std::string, std::string> bones_define() {
        return {"BONES", std::to_string(max_bones)};
    }

    void set_bone(std::size_t bone, const Eigen::Affine3f& world_from_bone) {
        for (int row = 0; row < 3; ++row)
            bone_rows[3 * bone + static_cast<std::size_t>(row)] =
                world_from_bone.matrix().row(row).transpose();
    }

    /// Draws the scenery's own shadows only.
    void take_performers_away() {
        shadow_target.bind();
        glBindFramebuffer(GL_READ_FRAMEBUFFER, still_shadow_target.name());
        glBlitFramebuffer(0, 0, shadow_side_px, shadow_side_px, 0, 0, shadow_side_px,
                          shadow_side_px, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
        posed_time.reset();
    }

    /// Moves the performers and their shadows to a time.
    void go_to(std::chrono::nanoseconds time) {
        if (posed_time == time) return;
        std::array<Eigen::Affine3f, bones_of_performer> bones;
        std::size_t bone = 1;
        for (const PerformerStyle& performer : scene.performers) {
            pose_performer(performer, time, bones);
            for (const Eigen::Affine3f& world_from_bone : bones) {
                set_bone(bone, world_from_bone);
                points_m_of_bone[bone].clear();
                for (const Eigen::Vector3f& at : vertices_of_bone[bone])
                    points_m_of_bone[bone].push_back(world_from_bone * at);
                ++bone;
            }
        }
        take_performers_away();
        draw_shadows(true);
        find_shaded();
        posed_time = time;
    }

    void draw_shadows(bool animated) {
        prepare_to_draw_solids();
        shadow_program.use();
        shadow_program.set("clip_from_world", shadow_from_world);
        shadow_program.set("bones", std::span<const Eigen::Vector4f>(bone_rows));
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(1.5f, 4.0f);
        vertex_array.bind();
        for (const StageChunk& chunk : scene.mesh.chunks())
            if (chunk.kind.casts_shadow && chunk.kind.animated == animated) draw(chunk);
        glDisable(GL_POLYGON_OFFSET_FILL);
    }

    static void draw(const StageChunk& chunk) {
        const std::size_t offset = chunk.first_index * sizeof(std::uint32_t);
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(chunk.index_count), GL_UNSIGNED_INT,
                       as_offset(offset));
    }

    /// The chunks that the camera may see, nearest first, to reduce overdraw.
    std::vector<const StageChunk*> in_view(const StageCamera& camera,
                                           const Eigen::Matrix4f& clip) const {
        const Frustum frustum = frustum_of(clip);
        const Eigen::Vector3f eye_m = camera.world_from_camera.translation().cast<float>();
        std::vector<std::pair<float, const StageChunk*>> seen;
        for (const StageChunk& chunk : scene.mesh.chunks()) {
            // Performers move within a sphere around the middle of the stage.
            const Eigen::Vector3f centre_m =
                chunk.kind.animated ? Eigen::Vector3f(0, 1, 0) : chunk.centre_m;
            const float radius_m = chunk.kind.animated ? 2.9f : chunk.radius_m;
            if (!may_see_sphere(frustum, centre_m, radius_m)) continue;
            // Large chunks mostly lie behind small ones.
            seen.emplace_back((centre_m - eye_m).norm() + (chunk.kind.animated ? 0 : radius_m),
                              &chunk);
        }
        std::stable_sort(seen.begin(), seen.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<const StageChunk*> chunks;
        chunks.reserve(seen.size());
        for (const auto& [distance_m, chunk] : seen) chunks.push_back(chunk);
        return chunks;
    }

    StageTargets& targets_for(cv::Size size, int samples_per_side) {
        const auto same = [&](const auto& t) {
            return t->size() == size && t->samples_per_side() == samples_per_side;
        };
        const auto at = std::find_if(targets.begin(), targets.end(), same);
        if (at != targets.end()) return **at;
        if (targets.size() == max_kept_targets) targets.erase(targets.begin());
        targets.push_back(std::make_unique<StageTargets>(size, samples_per_side));
        return *targets.back();
    }

    void prepare(Program& program, const StageCamera& camera, const Eigen::Matrix4f& clip) {
        const StageLighting& light = scene.lighting;
        program.use();
        program.set("clip_from_world", clip);
        program.set("shadow_from_world", shadow_from_world);
        program.set("bones", std::span<const Eigen::Vector4f>(bone_rows));
        program.set("key_direction", light.key_direction);
        program.set("key_colour", light.key_colour);
        program.set("fill_direction", light.fill_direction);
        program.set("fill_colour", light.fill_colour);
        program.set("rim_direction", light.rim_direction);
        program.set("rim_colour", light.rim_colour);
        program.set("sky_colour", light.sky_colour);
        program.set("ground_colour", light.ground_colour);
        program.set("eye_m", Eigen::Vector3f(camera.world_from_camera.translation().cast<float>()));
        program.input("textures", textures);
        program.input("shadow_map", shadow);
    }

    /// The cached image of a camera without performers, rendered if missing. Replaces the least
    /// recently used one.
    KeptScene& kept_scene(const StageCamera& camera, int samples_per_side) {
        const auto at = std::find_if(kept_scenes.begin(), kept_scenes.end(), [&](const auto& kept) {
            return kept->still.samples_per_side() == samples_per_side &&
                   are_same(kept->camera, camera);
        });
        if (at != kept_scenes.end()) {
            std::rotate(at, at + 1, kept_scenes.end());
            return *kept_scenes.back();
        }
        if (kept_scenes.size() == max_kept_scenes) kept_scenes.erase(kept_scenes.begin());
        kept_scenes.push_back(std::make_unique<KeptScene>(camera, samples_per_side));
        return *kept_scenes.back();
    }

    /// Collects the triangles of the scenery that receive shadows, and their shadow map texels.
    void find_shadeable() {
        const std::vector<std::uint32_t>& index = scene.mesh.indices();
        for (const StageChunk& chunk : scene.mesh.chunks()) {
            if (chunk.kind.animated || chunk.kind.shadow == ShadowLookup::none) continue;
            for (std::size_t i = chunk.first_index; i < chunk.first_index + chunk.index_count;
                 i += 3) {
                Triangle triangle{&chunk, i, {}, {}};
                for (std::size_t c = 0; c < 3; ++c) {
                    const auto& at = scene.mesh.vertices()[index[i + c]].position_m;
                    triangle.corners_m[c] = {at[0], at[1], at[2]};
                }
                triangle.in_shadow_map = in_shadow_map(triangle.corners_m);
                shadeable.push_back(triangle);
            }
        }
    }

    /// The texels of the shadow map through which the points may be shaded or cast shadows.
    cv::Rect in_shadow_map(std::span<const Eigen::Vector3f> points) const {
        constexpr float margin = shadow_margin_m * shadow_side_px / (2 * shadow_half_size_m);
        Eigen::Array2f low(1e9f, 1e9f), high(-1e9f, -1e9f);
        for (const Eigen::Vector3f& point : points) {
            const Eigen::Vector4f at = shadow_from_world * point.homogeneous();
            const Eigen::Array2f texel = (at.head<2>().array() + 1) * (0.5f * shadow_side_px);
            low = low.min(texel);
            high = high.max(texel);
        }
        const Eigen::Array2i from = (low - margin).floor().cast<int>(),
                             to = (high + margin).ceil().cast<int>();
        return {cv::Point(from.x(), from.y()), cv::Point(to.x(), to.y())};
    }

    /// Uploads the triangles that performers may shade at the moment, chunk by chunk.
    void find_shaded() {
        PictureParts dark({shadow_side_px, shadow_side_px});
        for (const std::vector<Eigen::Vector3f>& points : points_m_of_bone)
            if (!points.empty()) dark.add(in_shadow_map(points));
        shaded.clear();
        std::vector<std::uint32_t> order;
        for (std::size_t t = 0; t < shadeable.size(); ++t) {
            if (!dark.holds_any_of(shadeable[t].in_shadow_map)) continue;
            shaded.push_back(t);
            const auto first = scene.mesh.indices().begin() +
                               static_cast<std::ptrdiff_t>(shadeable[t].first_index);
            order.insert(order.end(), first, first + 3);
        }
        shaded_indices = Buffer::of(std::span(std::as_const(order)), GL_STREAM_DRAW);
    }

    /// Draws the surfaces under moving shadows again, at exactly the same depth.
    void draw_shaded(const StageCamera& camera, const Eigen::Matrix4f& clip) {
        std::vector<const StageChunk*> chunks;
        for (const std::size_t t : shaded)
            if (chunks.empty() || chunks.back() != shadeable[t].chunk)
                chunks.push_back(shadeable[t].chunk);
        glDepthFunc(GL_EQUAL);
        draw_colours(camera, clip, chunks, [&](const StageChunk& chunk) {
            const auto of_chunk = [&](std::size_t t) { return shadeable[t].chunk == &chunk; };
            const auto first = std::find_if(shaded.begin(), shaded.end(), of_chunk),
                       last = std::find_if_not(first, shaded.end(), of_chunk);
            shaded_indices->bind(GL_ELEMENT_ARRAY_BUFFER);
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * (last - first)), GL_UNSIGNED_INT,
                           as_offset(3 * sizeof(std::uint32_t) *
                                     static_cast<std::size_t>(first - shaded.begin())));
        });
        // The vertex array stores its index buffer.
        vertex_array.bind();
        indices.bind(GL_ELEMENT_ARRAY_BUFFER);
        glDepthFunc(GL_LESS);
    }

    /// The parts of the image that show performers or surfaces that they may shade.
    PictureParts changing_parts(const KeptScene& kept) const {
        const ScreenBounds bounds(kept.camera);
        PictureParts parts(kept.moving.size());
        for (const std::vector<Eigen::Vector3f>& points : points_m_of_bone)
            if (!points.empty()) parts.add(bounds.of(points));
        for (const std::size_t t : shaded) parts.add(kept.seen[t]);
        return parts;
    }

    /// Calls `draws` for each of `chunks` with its program in use.
    template <class Draws>
    void draw_colours(const StageCamera& camera, const Eigen::Matrix4f& clip,
                      const std::vector<const StageChunk*>& chunks, Draws draws) {
        vertex_array.bind();
        for (ColourProgram& way : colour_programs) {
            bool in_use = false;
            for (const StageChunk* chunk : chunks) {
                if (chunk->kind.glossy != way.glossy || chunk->kind.shadow != way.shadow) continue;
                if (!in_use) prepare(way.program, camera, clip);
                in_use = true;
                draws(*chunk);
            }
        }
    }

    void draw_colour(const StageCamera& camera, const StageTargets& target,
                     const std::vector<const StageChunk*>& chunks) {
        prepare_to_draw_solids();
        target.bind_colour();
        glClearColor(0, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        draw_colours(camera, clip_from_world(camera, near_m, far_m), chunks, draw);
        const cv::Rect whole({}, target.size());
        target.reduce_colour(reduce, {&whole, 1});
    }

    /// Draws performers and their shadows over the cached scenery.
    void draw_colour_over(KeptScene& kept, const std::vector<const StageChunk*>& chunks) {
        const StageCamera& camera = kept.camera;
        const StageTargets& target = kept.moving;
        const Eigen::Matrix4f clip = clip_from_world(camera, near_m, far_m);
        target.copy_samples(kept.still, kept.differing.rectangles());
        prepare_to_draw_solids();
        target.bind_colour();

        draw_shaded(camera, clip);
        draw_colours(camera, clip, moving(chunks), draw);

        PictureParts changed = changing_parts(kept);
        std::swap(kept.differing, changed);
        changed.add(kept.differing);
        target.reduce_colour(reduce, changed.rectangles());
    }

    void draw_depth(const StageCamera& camera, const std::vector<const StageChunk*>& chunks) {
        prepare_to_draw_solids();
        vertex_array.bind();
        depth_program.use();
        depth_program.set("clip_from_world", clip_from_world(camera, near_m, far_m));
        depth_program.set("bones", std::span<const Eigen::Vector4f>(bone_rows));
        for (const StageChunk* chunk : chunks) draw(*chunk);
    }

    void draw_whole_depth(const StageCamera& camera, const StageTargets& target,
                          const std::vector<const StageChunk*>& chunks) {
        prepare_to_draw_solids();
        target.bind_depth();
        constexpr GLuint nothing[4] = {0, 0, 0, 0};
        glClearBufferuiv(GL_COLOR, 0, nothing);
        glClear(GL_DEPTH_BUFFER_BIT);
        draw_depth(camera, chunks);
    }

    static std::vector<const StageChunk*> still(const std::vector<const StageChunk*>& chunks) {
        std::vector<const StageChunk*> still_ones;
        std::copy_if(chunks.begin(), chunks.end(), std::back_inserter(still_ones),
                     [](const StageChunk* chunk) { return !chunk->kind.animated; });
        return still_ones;
    }
    static std::vector<const StageChunk*> moving(const std::vector<const StageChunk*>& chunks) {
        std::vector<const StageChunk*> moving_ones;
        std::copy_if(chunks.begin(), chunks.end(), std::back_inserter(moving_ones),
                     [](const StageChunk* chunk) { return chunk->kind.animated; });
        return moving_ones;
    }

    StageRendering render(const StageCamera& camera, std::chrono::nanoseconds stage_time,
                          const StageOptions& options, int samples_per_side) {
        const std::vector<const StageChunk*> chunks =
            in_view(camera, clip_from_world(camera, near_m, far_m));
        const bool with_colour = options.pictures != StagePictures::depth,
                   with_depth = options.pictures != StagePictures::colour;
        KeptScene* kept = options.stands_still ? &kept_scene(camera, samples_per_side) : nullptr;
        const StageTargets& target =
            kept ? kept->moving
                 : targets_for({camera.width_px, camera.height_px}, samples_per_side);
        if (kept && with_colour && !kept->has_colour) {
            take_performers_away();
            draw_colour(camera, kept->still, still(chunks));
            const ScreenBounds bounds(camera);
            for (const Triangle& triangle : shadeable)
                kept->seen.push_back(bounds.of(triangle.corners_m));
            kept->has_colour = true;
        }
        if (kept && with_depth && !kept->has_depth) {
            draw_whole_depth(camera, kept->still, still(chunks));
            kept->has_depth = true;
        }
        go_to(stage_time);
        StageRendering rendering;
        if (with_colour) {
            if (kept)
                draw_colour_over(*kept, chunks);
            else
                draw_colour(camera, target, chunks);
            rendering.colour.create(camera.height_px, camera.width_px);
            target.read_colour(rendering.colour);
        }
        if (with_depth) {
            if (kept) {
                target.copy_depth(kept->still);
                target.bind_depth();
                draw_depth(camera, moving(chunks));
            } else {
                draw_whole_depth(camera, target, chunks);
            }
            rendering.depth_m.create(camera.height_px, camera.width_px);
            cv::Mat bits(rendering.depth_m.size(), CV_32SC1, rendering.depth_m.data);
            target.read_depth_bits(bits);
        }
        return rendering;
    }

    StageScene scene;
    Buffer vertices, indices;
    VertexArray vertex_array;
    LayeredTexture textures;
    Texture still_shadow, shadow;
    Framebuffer still_shadow_target, shadow_target;
    std::vector<ColourProgram> colour_programs;
    Program depth_program, shadow_program;
    FullscreenPass reduce;
    Eigen::Matrix4f shadow_from_world;
    std::vector<Eigen::Vector4f> bone_rows;
    std::vector<std::vector<Eigen::Vector3f>> vertices_of_bone;  ///< in the bone's frame
    std::vector<std::vector<Eigen::Vector3f>> points_m_of_bone;  ///< at the current time
    std::vector<Triangle> shadeable;
    std::vector<std::size_t> shaded;       ///< triangles that performers may shade at the moment
    std::optional<Buffer> shaded_indices;  ///< their corners
    std::optional<std::chrono::nanoseconds> posed_time;
    std::vector<std::unique_ptr<StageTargets>> targets;
    std::vector<std::unique_ptr<KeptScene>> kept_scenes;
};

VirtualStage::VirtualStage(const ShaderLibrary& library, std::uint64_t scene)
    : impl_(std::make_unique<Impl>(library, make_scene(scene))) {}
VirtualStage::~VirtualStage() = default;
VirtualStage::VirtualStage(VirtualStage&&) noexcept = default;
VirtualStage& VirtualStage::operator=(VirtualStage&&) noexcept = default;

StageRendering VirtualStage::render(const StageCamera& camera, std::chrono::nanoseconds stage_time,
                                    const StageOptions& options) {
    validate(camera);
    const bool samples_fit =
        2 * std::max(camera.width_px, camera.height_px) <= PiLimits::max_image_side_px;
    const StateGuard guard;
    return impl_->render(camera, stage_time, options, options.anti_aliased && samples_fit ? 2 : 1);
}

}  // namespace vantage
