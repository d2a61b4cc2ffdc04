#include <memory>
#include <vector>

#include <Eigen/LU>

#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Relative depth difference up to which the facets of two rigs count as one surface: about two
/// voxels of two pixels.
constexpr float softness = 0.01f;
/// Half a voxel's diagonal, in voxel sides: depth beyond it in front of or behind a facet is
/// clipped.
constexpr double half_diagonal = 0.87;

/// Microfacet billboarding (Yamazaki, Sagawa, Kawasaki, Ikeuchi, Sakauchi, "Microfacet
/// billboarding", 2002): the scene is cut into voxels and each drawn as a small square that faces
/// the camera, textured from the rigs and clipped by their depth, so that hair and leaves need no
/// surface that joins them.
class FacetRenderer final : public ViewRenderer {
  public:
    FacetRenderer(const ShaderLibrary& library, double voxel_px)
        : voxel_px_(voxel_px),
          draw_(Program::render(library, "facets.vert", "facets.frag")),
          blend_(library, "mesh_blend.frag", softness),
          blender_(library) {}

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& level) override {
        const std::vector<DrawnLayer> layers = layers_of(instant, view, level.rigs);
        // Voxels of all rigs stand in one grid, whichever of them are drawn.
        const RigSurface* first =
            instant.rigs.empty() ? nullptr : instant.rigs.front().surface.get();
        blender_.layers().draw(
            layers, view,
            [&](const RigSurface& surface, double near_m, const Framebuffer& depth_only) {
                draw(surface, *first, view, near_m, depth_only);
            });
        return blender_.blend(view, blend_);
    }

    bool note_origins(bool noted) override {
        blender_.note_origins(noted);
        return true;
    }
    const PixelOrigins* origins() const override { return blender_.origins(); }

  private:
    void draw(const RigSurface& surface, const RigSurface& first, const VirtualView& view,
              double near_m, const Framebuffer& depth_only) {
        depth_only.bind();
        glDepthMask(GL_TRUE);
        glClearDepthf(1.0f);
        glClear(GL_DEPTH_BUFFER_BIT);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glDisable(GL_CULL_FACE);
        glDisable(GL_BLEND);
        const DepthView& camera = surface.camera();
        const Pose& world_from_grid = first.camera().world_from_camera;
        const double voxel_m = voxel_px_ * first.median_depth_m() / first.K_depth()(0, 0);
        DepthView map = camera;
        map.K = surface.K_depth();
        const VirtualView grid{1, 1, Eigen::Matrix3d::Identity(), world_from_grid};
        draw_.use();
        draw_.input("depth_map", surface.depth());
        draw_.set("grid_from_pixel",
                  Eigen::Matrix4f(
                      target_from_pixel(grid, camera.world_from_camera, map.K).cast<float>()));
        draw_.set("target_from_grid",
                  Eigen::Matrix4f(
                      (view.world_from_camera.inverse() * world_from_grid).matrix().cast<float>()));
        draw_.set("clip_from_target",
                  Eigen::Matrix4f(clip_from_target(view, near_m).cast<float>()));
        draw_.set("pixel_from_target",
                  Eigen::Matrix4f(pixel_from_target_pixel(map, view).cast<float>()));
        draw_.set("voxel_m", static_cast<float>(voxel_m));
        draw_.set("reach_m", static_cast<float>(half_diagonal * voxel_m));
        vertices_.bind();
        glDrawArrays(GL_TRIANGLES, 0, 6 * surface.depth().size().area());
        glDisable(GL_DEPTH_TEST);
    }

    double voxel_px_;
    Program draw_;
    VertexArray vertices_;
    LayerPass blend_;
    LayerBlender blender_;
};

}  // namespace

SynthesiserEntry facets_synthesiser_entry() {
    return {
        .name = "facets",
        .summary =
            "one small square for each voxel, facing the camera, its texture clipped by depth",
        .make_preparer =
            [](const ShaderLibrary& library) { return std::make_unique<PlainPreparer>(library); },
        .make_renderer = {},
        .options = {{.name = "voxel-px",
                     .summary = "side of a voxel in pixels of the depth maps, at the first "
                                "rig's typical depth",
                     .by_default = "2",
                     .words = {},
                     .least = 0.5,
                     .most = 64}},
        .make_renderer_with = [](const ShaderLibrary& library, const SynthesiserChoices& choices)
            -> std::unique_ptr<ViewRenderer> {
            return std::make_unique<FacetRenderer>(library, choices.number("voxel-px"));
        }};
}

}  // namespace vantage
