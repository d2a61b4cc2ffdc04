#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/LU>

#include "host_app/gallery/camera_plane.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Number of cameras whose rays one pass adds.
constexpr std::size_t cameras_per_pass = 4;

std::vector<Pose> poses_of(const Instant& instant) {
    std::vector<Pose> poses;
    for (const InstantRig& rig : instant.rigs) poses.push_back(rig.camera().world_from_camera);
    return poses;
}

/// Light field rendering (Levoy and Hanrahan, 1996): every pixel's ray is resampled from the rays
/// of many cameras by where it meets their plane and the focal plane; no geometry is needed.
class LightFieldRenderer final : public ViewRenderer {
  public:
    LightFieldRenderer(const ShaderLibrary& library, const SynthesiserChoices& choices)
        : focal_m_(choices.number("focal-m")),
          aperture_m_(choices.number("aperture-m")),
          is_corrected_(choices.word("rays") == "corrected"),
          end_(library, "lightfield_end.frag"),
          surface_(library, "mesh_blend.frag", same_surface_share),
          layers_(library),
          filler_(library) {
        for (std::size_t cameras = 1; cameras <= cameras_per_pass; ++cameras)
            add_.emplace_back(library, "lightfield_add.frag",
                              ShaderDefines{{"CAMERAS", std::to_string(cameras)}});
    }

    std::string lacks(const Instant& instant, const VirtualView& /*view*/) const override {
        const CameraPlane plane = camera_plane(poses_of(instant));
        if (!plane.refusal.empty()) return plane.refusal;
        if (focal_m(instant, plane) == 0)
            return "no view has depth to place the focal plane: give its distance, as in "
                   "lightfield:focal-m=3";
        return {};
    }

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& /*level*/) override {
        picture_.resize({view.width_px, view.height_px});
        const CameraPlane plane = camera_plane(poses_of(instant));
        const double focal = plane.refusal.empty() ? focal_m(instant, plane) : 0;
        if (focal == 0) {
            picture_.clear();
        } else {
            find_surface(instant, view);
            for (DrawnTexture& sum : sums_) sum.resize({view.width_px, view.height_px});
            sums_[0].target().bind();
            const float nothing[4] = {0, 0, 0, 0};
            glClearBufferfv(GL_COLOR, 0, nothing);
            for (std::size_t i = 0; i < instant.rigs.size(); i += cameras_per_pass) {
                add(instant, plane, focal, view, i);
                std::swap(sums_[0], sums_[1]);
            }
            end_.use().input("sum", sums_[0].texture());
            end_.draw(picture_.target());
        }
        return filler_.fill(picture_.colour(), picture_.depth_m());
    }

  private:
    /// Returns the distance of the focal plane from the cameras' plane; 0: unknown.
    double focal_m(const Instant& instant, const CameraPlane& plane) const {
        if (focal_m_ > 0) return focal_m_;
        std::vector<double> depths_m;
        const Pose plane_from_world = plane.world_from_plane.inverse();
        for (const InstantRig& rig : instant.rigs)
            for (const Eigen::Vector3d& point : rig.sample_points_m())
                depths_m.push_back((plane_from_world * point).z());
        if (depths_m.empty()) return 0;
        const auto middle = depths_m.begin() + static_cast<std::ptrdiff_t>(depths_m.size() / 2);
        std::nth_element(depths_m.begin(), middle, depths_m.end());
        return std::max(*middle, 1e-6);
    }

    /// Draws the surfaces of the views with depth, if rays are corrected by them.
    void find_surface(const Instant& instant, const VirtualView& view) {
        geometry_.resize({view.width_px, view.height_px});
        layers_.draw(
            is_corrected_ ? layers_of(instant, view, most_drawn_rigs) : std::vector<DrawnLayer>{},
            view);
        if (layers_.used().empty())
            geometry_.clear();
        else
            surface_.use(layers_, false).draw(geometry_.target());
    }

    /// Adds the rays of the cameras from `first` on to sums_[0] and stores the result in sums_[1].
    void add(const Instant& instant, const CameraPlane& plane, double focal,
             const VirtualView& view, std::size_t first) {
        const std::size_t count = std::min(cameras_per_pass, instant.rigs.size() - first);
        FullscreenPass& pass = add_[count - 1];
        Program& program = pass.use();
        const Pose target_from_plane = view.world_from_camera.inverse() * plane.world_from_plane;
        const auto set_plane = [&](const char* name, double ahead_m) {
            const Eigen::Vector3d normal = target_from_plane.linear().col(2);
            const Eigen::Vector3d on = target_from_plane * Eigen::Vector3d(0, 0, ahead_m);
            program.set(name, Eigen::Vector4f(normal.cast<float>().homogeneous().cwiseProduct(
                                  Eigen::Vector4f(1, 1, 1, static_cast<float>(normal.dot(on))))));
        };
        set_plane("camera_plane", 0);
        set_plane("focal_plane", focal);
        program.set("camera_x", Eigen::Vector3f(target_from_plane.linear().col(0).cast<float>()));
        program.set("camera_y", Eigen::Vector3f(target_from_plane.linear().col(1).cast<float>()));
        program.set("camera_middle",
                    Eigen::Vector3f(target_from_plane.translation().cast<float>()));
        program.set("ray_from_pixel", Eigen::Matrix3f(view.K.inverse().cast<float>()));
        program.set("corrected", is_corrected_ ? 1.0f : 0.0f);
        program.input("sum_before", sums_[0].texture());
        program.input("surface", geometry_.depth_m());
        for (std::size_t i = 0; i < count; ++i) {
            const RigSurface& camera = *instant.rigs[first + i].surface;
            const PlacedCamera& placed = plane.cameras[first + i];
            program.input("colour", i, camera.colour());
            program.input("source_depth", i, camera.depth());
            program.set(
                "pixel_from_target", i,
                Eigen::Matrix4f(pixel_from_target_pixel(camera.camera(), view).cast<float>()));
            program.set("place", i, Eigen::Vector2f(placed.at_m.cast<float>()));
            Eigen::Vector4d reach = placed.reach_m;
            for (double& side : reach)
                if (side > 0) side = std::max(side, 0.5 * aperture_m_);
            program.set("reach", i, Eigen::Vector4f(reach.cast<float>()));
        }
        pass.draw(sums_[1].target());
    }

    double focal_m_, aperture_m_;
    bool is_corrected_;
    std::vector<FullscreenPass> add_;  ///< one for every number of cameras
    FullscreenPass end_;
    LayerPass surface_;
    RigLayers layers_;
    HoleFiller filler_;
    DrawnTexture sums_[2] = {DrawnTexture(TextureFormat::rgba32f),
                             DrawnTexture(TextureFormat::rgba32f)};
    DepthPicture geometry_, picture_;
};

}  // namespace

SynthesiserEntry lightfield_synthesiser_entry() {
    return {.name = "lightfield",
            .summary = "rays of a row or grid of cameras resampled, without geometry",
            .make_preparer =
                [](const ShaderLibrary& library) {
                    return std::make_unique<PlainPreparer>(library, true);
                },
            .make_renderer = {},
            .tells_origins = false,
            .needs_depth = false,
            .options = {{.name = "focal-m",
                         .summary = "of the focal plane from the cameras' one, metres; 0: the "
                                    "median depth of what the views show",
                         .by_default = "0",
                         .words = {},
                         .least = 0,
                         .most = 10000},
                        {.name = "aperture-m",
                         .summary = "width of the aperture, metres; from one camera to the next "
                                    "at least",
                         .by_default = "0",
                         .words = {},
                         .least = 0,
                         .most = 1000},
                        {.name = "rays",
                         .summary = "plain, or corrected by the depth that the views have",
                         .by_default = "plain",
                         .words = {"plain", "corrected"}}},
            .make_renderer_with =
                [](const ShaderLibrary& library,
                   const SynthesiserChoices& choices) -> std::unique_ptr<ViewRenderer> {
                return std::make_unique<LightFieldRenderer>(library, choices);
            }};
}

}  // namespace vantage
