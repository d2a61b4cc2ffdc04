#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "host_app/gallery/tour_preparer.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/pull_push.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/projection.h"
#include "host_app/views/view_ranking.h"

namespace vantage {
namespace {

/// Share of a rig's surface points that lie nearer than the back plane.
constexpr double back_share = 0.85;
/// Least distance of the virtual camera to the back plane, relative to the rig's.
constexpr double min_distance_share = 0.1;

/// The upright layout of a single camera's video, in world coordinates.
struct Layout {
    Eigen::Vector3d up, ahead;  ///< unit; ahead is level
    double floor_m = 0;         ///< of the floor along up
    double back_m = 0;          ///< of the back plane along ahead
};

/// Tour into the video (Kang and Shin, "Tour into the video: image-based navigation scheme for
/// video sequences of dynamic scenes", 2002): the video of one camera. Its learnt background is
/// projected onto a floor and a back plane; its foreground stands on the floor as billboards.
class TourRenderer final : public ViewRenderer {
  public:
    TourRenderer(const ShaderLibrary& library, const SynthesiserChoices& choices)
        : up_(choices.word("up")),
          floor_m_(choices.number("floor-m")),
          back_m_(choices.number("back-m")),
          draw_(library, "tour.frag"),
          filler_(library) {}

    std::string lacks(const Instant& instant, const VirtualView& view) const override {
        const InstantRig* rig = rig_for(instant, view);
        if (!rig)
            return "tour shows the video of one rig, and no rig sees what the camera looks at: "
                   "turn the camera";
        const Layout layout = layout_of(*rig);
        const Eigen::Vector3d eye = view.world_from_camera.translation();
        if (std::abs(layout.ahead.norm() - 1) > 0.01)
            return fmt::format(
                "rig {} faces straight up or down, so that no upright layout fits it: give the up "
                "axis, as in tour:up=z",
                rig->camera().name);
        if (layout.up.dot(rig->camera().world_from_camera.translation()) <= layout.floor_m)
            return fmt::format(
                "rig {} is below the floor of the tour: give the floor's height, as in "
                "tour:up=-y,floor-m=-1",
                rig->camera().name);
        const double before_m = layout.back_m - layout.ahead.dot(eye);
        const double own_m =
            layout.back_m - layout.ahead.dot(rig->camera().world_from_camera.translation());
        if (layout.up.dot(eye) <= layout.floor_m || before_m < min_distance_share * own_m)
            return "the tour's camera must stay above the floor and in front of the back plane";
        return {};
    }

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& /*level*/) override {
        picture_.resize({view.width_px, view.height_px});
        const auto* tour = dynamic_cast<const TourInstant*>(instant.extra.get());
        const InstantRig* rig = rig_for(instant, view);
        if (!tour || !rig || !lacks(instant, view).empty())
            picture_.clear();
        else
            draw(*tour, static_cast<std::size_t>(rig - instant.rigs.data()), view);
        return filler_.fill(picture_.colour(), picture_.depth_m());
    }

  private:
    static const InstantRig* rig_for(const Instant& instant, const VirtualView& view) {
        std::vector<const InstantRig*> all;
        for (const InstantRig& rig : instant.rigs) all.push_back(&rig);
        const auto best = most_useful(all, view, 1);
        return best.empty() ? nullptr : best.front();
    }

    Layout layout_of(const InstantRig& rig) const {
        Layout layout;
        layout.up = Eigen::Vector3d::Zero();
        layout.up[up_.back() == 'y' ? 1 : 2] = up_.front() == '-' ? -1 : 1;
        const Eigen::Vector3d looks = rig.camera().world_from_camera.linear().col(2);
        layout.ahead = (looks - looks.dot(layout.up) * layout.up).normalized();
        layout.floor_m = floor_m_;
        const double from_m = layout.ahead.dot(rig.camera().world_from_camera.translation());
        if (back_m_ > 0) {
            layout.back_m = from_m + back_m_;
            return layout;
        }
        std::vector<double> ahead_m;
        for (const Eigen::Vector3d& point : rig.sample_points_m())
            ahead_m.push_back(layout.ahead.dot(point));
        const auto at = ahead_m.begin() + static_cast<std::ptrdiff_t>(
                                              back_share * static_cast<double>(ahead_m.size()));
        std::nth_element(ahead_m.begin(), at, ahead_m.end());
        layout.back_m = *at;
        return layout;
    }

    /// Returns where a pixel's line of sight meets the floor, or the back plane if that is nearer.
    static Eigen::Vector3d stands_at(const DepthView& camera, const cv::Point2d& pixel,
                                     const Layout& layout) {
        const Eigen::Vector3d eye = camera.world_from_camera.translation();
        const Eigen::Vector3d ray = camera.world_from_camera.linear() *
                                    (camera.K.inverse() * Eigen::Vector3d(pixel.x, pixel.y, 1));
        double along = (layout.back_m - layout.ahead.dot(eye)) / layout.ahead.dot(ray);
        if (const double down = layout.up.dot(ray); down < 0)
            along = std::min(along, (layout.floor_m - layout.up.dot(eye)) / down);
        return eye + along * ray;
    }

    void draw(const TourInstant& tour, std::size_t number, const VirtualView& view) {
        const InstantRig& rig = tour.performers->rigs[number];
        const auto& told = dynamic_cast<const ForegroundInstant&>(*tour.performers->extra);
        const DepthView& camera = rig.camera();
        const Layout layout = layout_of(rig);
        Program& program = draw_.use();
        const Pose target_from_world = view.world_from_camera.inverse();
        const auto set_plane = [&](const std::string& name, const Eigen::Vector3d& normal,
                                   double distance_m) {
            Eigen::Vector4d plane;
            plane << target_from_world.linear() * normal,
                distance_m - normal.dot(view.world_from_camera.translation());
            program.set(name, Eigen::Vector4f(plane.cast<float>()));
        };
        set_plane("floor_plane", layout.up, layout.floor_m);
        set_plane("back_plane", layout.ahead, layout.back_m);
        const std::vector<CutOut>& parts = tour.rigs[number].cut_outs;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const Eigen::Vector3d foot = stands_at(camera, parts[i].foot_px, layout);
            Eigen::Vector3d facing = foot - camera.world_from_camera.translation();
            facing = (facing - facing.dot(layout.up) * layout.up).normalized();
            set_plane(fmt::format("billboards[{}]", i), facing, facing.dot(foot));
        }
        program.set("cut_outs", static_cast<int>(parts.size()));
        program.set("pixel_from_target",
                    Eigen::Matrix4f(pixel_from_target_pixel(camera, view).cast<float>()));
        const Texture& picture = rig.surface->colour();
        program.set("picture_size", Eigen::Vector2f(static_cast<float>(picture.width_px()),
                                                    static_cast<float>(picture.height_px())));
        program.set("ray_from_pixel", Eigen::Matrix3f(view.K.inverse().cast<float>()));
        program.input("background_colour", told.rigs[number].background->colour());
        program.input("picture", picture);
        program.input("matte", told.rigs[number].matte->share.texture());
        program.input("numbers", *tour.rigs[number].labels->numbers);
        draw_.draw(picture_.target());
    }

    std::string up_;
    double floor_m_, back_m_;
    FullscreenPass draw_;
    HoleFiller filler_;
    DepthPicture picture_;
};

}  // namespace

SynthesiserEntry tour_synthesiser_entry() {
    return {
        .name = "tour",
        .summary = "one rig's video on a floor and a back plane, the foreground as billboards",
        .make_preparer =
            [](const ShaderLibrary& library) { return std::make_unique<TourPreparer>(library); },
        .make_renderer = {},
        .tells_origins = false,
        .options = {{.name = "up",
                     .summary = "the world's axis that points up: y, -y, z or -z",
                     .by_default = "y",
                     .words = {"y", "-y", "z", "-z"}},
                    {.name = "floor-m",
                     .summary = "height of the floor along it, metres",
                     .by_default = "0",
                     .words = {},
                     .least = -10000,
                     .most = 10000},
                    {.name = "back-m",
                     .summary = "level distance of the back plane from the rig, metres; 0: "
                                "beyond most of what its depth shows",
                     .by_default = "0",
                     .words = {},
                     .least = 0,
                     .most = 10000}},
        .make_renderer_with = [](const ShaderLibrary& library, const SynthesiserChoices& choices)
            -> std::unique_ptr<ViewRenderer> {
            return std::make_unique<TourRenderer>(library, choices);
        }};
}

}  // namespace vantage
