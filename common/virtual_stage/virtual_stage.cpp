#include "common/virtual_stage/virtual_stage.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/gl/buffer.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/limits.h"
#include "common/gl/program.h"
#include "common/gl/vertex_array.h"
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
constexpr std::size_t kept_targets = 4;

enum TextureUnit { unit_textures, unit_shadow };

/// Set before every pass: the pass before may have been another's.
void prepare_to_draw_solids() {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_CULL_FACE);
    // Row 0 on top turns the picture over, and with it the winding of front faces.
    glFrontFace(GL_CW);
}

/// Puts framebuffer and viewport back, and the rest to GL's own defaults.
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

/// The shaders for one way of looking a surface up.
struct ColourProgram {
    ShadowLookup shadow;
    bool glossy;
    Program program;
};

GlHandle<delete_texture> upload_textures(std::uint64_t seed) {
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
    // The steps between mip levels vanish in the samples of a pixel, and it is far cheaper than
    // blending levels.
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
    check_gl("loading the virtual stage's textures");
    return handle;
}

Texture make_shadow_texture(bool compared) {
    Texture texture(TextureFormat::depth24, shadow_side_px, shadow_side_px,
                    compared ? Filter::linear : Filter::nearest);
    if (compared) {
        texture.bind(unit_shadow);
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
            "the virtual camera's K needs focal lengths above 0 and the last row 0 0 1, and has "
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
          bone_rows(3 * (1 + scene.performers.size() * bones_of_performer)) {
        assert(bone_rows.size() <= std::size_t{3} * max_bones);
        set_bone(0, Eigen::Affine3f::Identity());
        const StateGuard guard;
        still_shadow_target.bind();
        glClear(GL_DEPTH_BUFFER_BIT);
        draw_shadows(false);
    }

    /// The programs by what is drawn first: near and small before far and large.
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

    /// Moves the performers and their shadows to a time, unless they are there.
    void go_to(std::chrono::nanoseconds time) {
        if (posed_time == time) return;
        std::array<Eigen::Affine3f, bones_of_performer> bones;
        std::size_t bone = 1;
        for (const PerformerStyle& performer : scene.performers) {
            pose_performer(performer, time, bones);
            for (const Eigen::Affine3f& world_from_bone : bones) set_bone(bone++, world_from_bone);
        }
        shadow_target.bind();
        glBindFramebuffer(GL_READ_FRAMEBUFFER, still_shadow_target.name());
        glBlitFramebuffer(0, 0, shadow_side_px, shadow_side_px, 0, 0, shadow_side_px,
                          shadow_side_px, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
        draw_shadows(true);
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

    /// The chunks that the camera may see, nearest first, so that little is drawn to be covered.
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
            // What is large lies behind what is small, mostly.
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
        if (targets.size() == kept_targets) targets.erase(targets.begin());
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
        program.set("textures", static_cast<int>(unit_textures));
        program.set("shadow_map", static_cast<int>(unit_shadow));
    }

    void draw_colour(const StageCamera& camera, StageTargets& target, ColourImage& picture) {
        const Eigen::Matrix4f clip = clip_from_world(camera, near_m, far_m);
        const std::vector<const StageChunk*> chunks = in_view(camera, clip);
        prepare_to_draw_solids();
        target.bind_colour();
        glClearColor(0, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glActiveTexture(GL_TEXTURE0 + unit_textures);
        glBindTexture(GL_TEXTURE_2D_ARRAY, textures.name());
        shadow.bind(unit_shadow);
        vertex_array.bind();
        for (ColourProgram& way : colour_programs) {
            bool in_use = false;
            for (const StageChunk* chunk : chunks) {
                if (chunk->kind.glossy != way.glossy || chunk->kind.shadow != way.shadow) continue;
                if (!in_use) prepare(way.program, camera, clip);
                in_use = true;
                draw(*chunk);
            }
        }
        picture.create(camera.height_px, camera.width_px);
        target.read_colour(reduce, picture);
    }

    void draw_depth(const StageCamera& camera, StageTargets& target, DepthImage& depth_m) {
        const Eigen::Matrix4f clip = clip_from_world(camera, near_m, far_m);
        prepare_to_draw_solids();
        target.bind_depth();
        constexpr GLuint nothing[4] = {0, 0, 0, 0};
        glClearBufferuiv(GL_COLOR, 0, nothing);
        glClear(GL_DEPTH_BUFFER_BIT);
        vertex_array.bind();
        depth_program.use();
        depth_program.set("clip_from_world", clip);
        depth_program.set("bones", std::span<const Eigen::Vector4f>(bone_rows));
        for (const StageChunk* chunk : in_view(camera, clip)) draw(*chunk);
        depth_m.create(camera.height_px, camera.width_px);
        cv::Mat bits(depth_m.size(), CV_32SC1, depth_m.data);
        target.read_depth_bits(bits);
    }

    StageScene scene;
    Buffer vertices, indices;
    VertexArray vertex_array;
    GlHandle<delete_texture> textures;
    Texture still_shadow, shadow;
    Framebuffer still_shadow_target, shadow_target;
    std::vector<ColourProgram> colour_programs;
    Program depth_program, shadow_program;
    FullscreenPass reduce;
    Eigen::Matrix4f shadow_from_world;
    std::vector<Eigen::Vector4f> bone_rows;
    std::optional<std::chrono::nanoseconds> posed_time;
    std::vector<std::unique_ptr<StageTargets>> targets;
};

VirtualStage::VirtualStage(const ShaderLibrary& library)
    : impl_(std::make_unique<Impl>(library, make_studio_set())) {}
VirtualStage::VirtualStage(const ShaderLibrary& library, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(library, make_random_set(seed))) {}
VirtualStage::~VirtualStage() = default;
VirtualStage::VirtualStage(VirtualStage&&) noexcept = default;
VirtualStage& VirtualStage::operator=(VirtualStage&&) noexcept = default;

StageRendering VirtualStage::render(const StageCamera& camera, std::chrono::nanoseconds stage_time,
                                    const StageOptions& options) {
    validate(camera);
    const bool samples_fit =
        2 * std::max(camera.width_px, camera.height_px) <= PiLimits::max_image_side_px;
    StageTargets& target = impl_->targets_for({camera.width_px, camera.height_px},
                                              options.anti_aliased && samples_fit ? 2 : 1);
    const StateGuard guard;
    impl_->go_to(stage_time);
    StageRendering rendering;
    if (options.pictures != StagePictures::depth)
        impl_->draw_colour(camera, target, rendering.colour);
    if (options.pictures != StagePictures::colour)
        impl_->draw_depth(camera, target, rendering.depth_m);
    return rendering;
}

}  // namespace vantage
