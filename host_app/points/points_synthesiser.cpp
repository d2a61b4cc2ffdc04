#include <memory>
#include <optional>
#include <vector>

#include <Eigen/LU>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Draws every pixel of every rig as a splat and cuts, blends and fills nothing, so that the depth
/// maps can be inspected.
class PointsRenderer final : public ViewRenderer {
  public:
    explicit PointsRenderer(const ShaderLibrary& library)
        : draw_(Program::render(library, "points.vert", "points.frag")) {}

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& /*level*/) override {
        if (!picture_ || picture_->colour.size() != cv::Size(view.width_px, view.height_px))
            picture_.emplace(view.width_px, view.height_px);
        picture_->clear();
        const std::vector<DrawnLayer> useful = layers_of(instant, view, instant.rigs.size());
        for (const DrawnLayer& source : useful) draw(*source.surface, view, near_plane_m(useful));
        return picture_->colour;
    }

    const Texture* depth_m() const override { return picture_ ? &picture_->z : nullptr; }

  private:
    struct Picture {
        Texture colour, z, depth;
        Framebuffer target;
        Picture(int width_px, int height_px)
            : colour(TextureFormat::rgba8, width_px, height_px, Filter::linear),
              z(TextureFormat::r32f, width_px, height_px),
              depth(TextureFormat::depth24, width_px, height_px),
              target({&colour, &z}, &depth) {}

        void clear() const {
            target.bind();
            glDepthMask(GL_TRUE);
            const float nothing[4] = {0, 0, 0, 0}, farthest = 1;
            glClearBufferfv(GL_COLOR, 0, nothing);
            glClearBufferfv(GL_COLOR, 1, nothing);
            glClearBufferfv(GL_DEPTH, 0, &farthest);
        }
    };

    void draw(const RigSurface& source, const VirtualView& view, double near_m) {
        picture_->target.bind();
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glDisable(GL_BLEND);
        draw_.use();
        draw_.input("depth_map", source.depth());
        draw_.input("picture", source.colour());
        const Pose& pose = source.camera().world_from_camera;
        draw_.set("clip_from_pixel",
                  Eigen::Matrix4f((clip_from_target(view, near_m) *
                                   target_from_pixel(view, pose, source.K_depth()))
                                      .cast<float>()));
        draw_.set("ray_from_pixel", Eigen::Matrix3f(source.K_depth().inverse().cast<float>()));
        draw_.set(
            "centre",
            Eigen::Vector3f((pose.inverse() * view.world_from_camera.translation()).cast<float>()));
        draw_.set("scale", static_cast<float>(view.K(0, 0) / source.K_depth()(0, 0)));
        vertices_.bind();
        glDrawArrays(GL_POINTS, 0, source.depth().width_px() * source.depth().height_px());
        glDisable(GL_DEPTH_TEST);
    }

    Program draw_;
    VertexArray vertices_;
    std::optional<Picture> picture_;
};

}  // namespace

SynthesiserEntry points_synthesiser_entry() {
    return {"points", "a splat for every pixel of every rig, for inspection",
            [](const ShaderLibrary& library) { return std::make_unique<PlainPreparer>(library); },
            [](const ShaderLibrary& library) { return std::make_unique<PointsRenderer>(library); },
            false};
}

}  // namespace vantage
