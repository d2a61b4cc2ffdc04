#include <memory>
#include <optional>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "common/gl/framebuffer.h"
#include "common/gl/fullscreen_pass.h"
#include "host_app/fusion/gpu_view.h"
#include "host_app/fusion/hole_filler.h"
#include "host_app/fusion/mesh_rasteriser.h"
#include "host_app/fusion/projection.h"
#include "host_app/fusion/synthesiser.h"
#include "host_app/fusion/view_ranking.h"

namespace vantage {
namespace {

constexpr std::size_t max_layers = 4;
/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
constexpr float softness = 0.01f;
/// Disparities are trusted to this many pixels.
constexpr double disparity_sigma_px = 0.5;

/// The system of Edling and Franke (2006): every rig's depth map as a quad grid displaced by depth,
/// stretched quads cut by an edge filter, and the rigs' meshes blended by viewing angle where they
/// show the same surface.
class MeshSynthesiser final : public Synthesiser {
  public:
    explicit MeshSynthesiser(const ShaderLibrary& library)
        : rasteriser_(library), filler_(library) {
        for (std::size_t layers = 1; layers <= max_layers; ++layers)
            blend_.emplace_back(library, "mesh_blend.frag",
                                ShaderDefines{{"LAYERS", std::to_string(layers)}});
    }

    void set_views(std::span<const DepthView> views) override {
        upload_views(views, views_);
        for (const auto& view : views_) rasteriser_.build_triangles(*view);
    }

    const Texture& render(const VirtualView& view) override {
        resize({view.width_px, view.height_px});
        const std::vector<const GpuView*> used = most_useful(views_, view, max_layers);
        const double near_m = near_plane_m(used);
        for (std::size_t i = 0; i < used.size(); ++i)
            rasteriser_.draw_depth(*used[i], view, near_m, layers_[i]->target);
        blend(used, view, near_m);
        return filler_.fill(*blended_, *blended_depth_m_);
    }

  private:
    struct Layer {
        Texture depth;
        Framebuffer target;
        explicit Layer(cv::Size size)
            : depth(TextureFormat::depth24, size.width, size.height), target({}, &depth) {}
    };

    void resize(cv::Size size) {
        if (blended_ && blended_->size() == size) return;
        layers_.clear();
        for (std::size_t i = 0; i < max_layers; ++i)
            layers_.push_back(std::make_unique<Layer>(size));
        target_.reset();
        blended_.emplace(TextureFormat::rgba8, size.width, size.height);
        blended_depth_m_.emplace(TextureFormat::r32f, size.width, size.height);
        target_.emplace(std::initializer_list<const Texture*>{&*blended_, &*blended_depth_m_});
    }

    void blend(const std::vector<const GpuView*>& used, const VirtualView& view, double near_m) {
        if (used.empty()) {
            target_->bind();
            const float nothing[4] = {0, 0, 0, 0};
            glClearBufferfv(GL_COLOR, 0, nothing);
            glClearBufferfv(GL_COLOR, 1, nothing);
            return;
        }
        FullscreenPass& pass = blend_[used.size() - 1];
        Program& program = pass.use();
        const Pose target_from_world = view.world_from_camera.inverse();
        for (std::size_t i = 0; i < used.size(); ++i) {
            const int unit = static_cast<int>(i);
            const DepthView& camera = used[i]->camera();
            const Eigen::Vector3d centre =
                target_from_world * camera.world_from_camera.translation();
            const double f_baseline = camera.K(0, 0) * camera.baseline_m;
            program.set(fmt::format("depth[{}]", i), unit);
            program.set(fmt::format("colour[{}]", i), unit + static_cast<int>(max_layers));
            program.set(fmt::format("pixel_from_target[{}]", i),
                        Eigen::Matrix4f(pixel_from_target_pixel(camera, view).cast<float>()));
            program.set(fmt::format("centre[{}]", i), Eigen::Vector3f(centre.cast<float>()));
            program.set(fmt::format("spread[{}]", i),
                        f_baseline > 0 ? static_cast<float>(disparity_sigma_px / f_baseline) : 0);
            layers_[i]->depth.bind(unit);
            used[i]->colour().bind(unit + static_cast<int>(max_layers));
        }
        program.set("ray_from_pixel", Eigen::Matrix3f(view.K.inverse().cast<float>()));
        program.set("near_m", static_cast<float>(near_m));
        program.set("softness", softness);
        pass.draw(*target_);
    }

    std::vector<std::unique_ptr<GpuView>> views_;
    MeshRasteriser rasteriser_;
    HoleFiller filler_;
    std::vector<FullscreenPass> blend_;  ///< one for every number of layers
    std::vector<std::unique_ptr<Layer>> layers_;
    std::optional<Texture> blended_, blended_depth_m_;
    std::optional<Framebuffer> target_;
};

}  // namespace

SynthesiserEntry mesh_synthesiser_entry() {
    return {
        "mesh", "quad grids displaced by depth, cut at edges, blended by viewing angle",
        [](const ShaderLibrary& library) { return std::make_unique<MeshSynthesiser>(library); }};
}

}  // namespace vantage
