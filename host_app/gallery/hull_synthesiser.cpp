#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "host_app/gallery/foreground_preparer.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

constexpr std::size_t most_rigs = RigLayers::max_layers;
/// Range of depth that is searched for foreground, relative to the rigs' typical depth.
constexpr double nearest_share = 0.3, farthest_share = 3;

struct SeenRig {
    const InstantRig* now;
    const ForegroundInstant::Rig* apart;
};

std::vector<SeenRig> rigs_with_silhouettes(const Instant& instant) {
    std::vector<SeenRig> rigs;
    const auto* performers = dynamic_cast<const ForegroundInstant*>(instant.extra.get());
    for (std::size_t i = 0; performers && i < performers->rigs.size(); ++i)
        if (performers->rigs[i].is_known) rigs.push_back({&instant.rigs[i], &performers->rigs[i]});
    return rigs;
}

/// Image-based visual hulls (Matusik et al., 2000): the foreground's silhouettes are intersected
/// along each pixel's line of sight, in the rigs' images and without a volume, and the nearest
/// point of the intersection is shaded from the rigs that see it. The background is drawn as quad
/// grids.
class HullRenderer final : public ViewRenderer {
  public:
    explicit HullRenderer(const ShaderLibrary& library)
        : blend_background_(library, "mesh_blend.frag", same_surface_share), blender_(library) {
        for (std::size_t rigs = 1; rigs <= most_rigs; ++rigs) {
            const ShaderDefines defines{{"RIGS", std::to_string(rigs)}};
            depth_.emplace_back(library, "hull_depth.frag", defines);
            shade_.emplace_back(library, "hull_shade.frag", defines);
        }
    }

    std::string lacks(const Instant& instant, const VirtualView& /*view*/) const override {
        const std::size_t rigs = rigs_with_silhouettes(instant).size();
        if (rigs >= 2) return {};
        return fmt::format(
            "hull intersects silhouettes against the background of at least two rigs and knows the "
            "background of {}: give earlier instants (--earlier), or let it run for some",
            rigs);
    }

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& level) override {
        const std::vector<SeenRig> all = rigs_with_silhouettes(instant);
        choose(all, view, std::min(level.rigs, most_rigs));
        std::vector<DrawnLayer> sets;
        if (used_.size() >= 2)
            for (const SeenRig& rig : used_)
                sets.push_back({rig.apart->background.get(), rig.now->presence});
        blender_.layers().draw(sets, view);
        return blender_.blend(
            view,
            [&](const DepthPicture& into, bool notes_origins) {
                blend_background_.use(blender_.layers(), notes_origins).draw(into.target());
            },
            [&](const DepthPicture& set) -> const DepthPicture& {
                return used_.size() < 2 ? set : lay_hull(set, view);
            });
    }

  private:
    void choose(const std::vector<SeenRig>& all, const VirtualView& view, std::size_t most) {
        std::vector<const InstantRig*> now;
        for (const SeenRig& rig : all) now.push_back(rig.now);
        used_.clear();
        for (const InstantRig* rig : most_useful(now, view, most))
            used_.push_back(*std::find_if(all.begin(), all.end(),
                                          [&](const SeenRig& one) { return one.now == rig; }));
    }

    void bind_silhouettes(Program& program, const VirtualView& target) {
        for (std::size_t i = 0; i < used_.size(); ++i) {
            const SeenRig& rig = used_[i];
            const Texture& matte = rig.apart->matte->share.texture();
            program.input("matte", i, matte);
            program.input("background_depth", i, rig.apart->background->depth());
            program.set(
                "pixel_from_target", i,
                Eigen::Matrix4f(pixel_from_target_pixel(rig.now->camera(), target).cast<float>()));
            program.set("picture_size", i,
                        Eigen::Vector2f(static_cast<float>(matte.width_px()),
                                        static_cast<float>(matte.height_px())));
        }
    }

    void find_depth(const VirtualView& target, const Texture* background_behind,
                    DrawnTexture& into) {
        double typical_m = 0;
        for (const SeenRig& rig : used_)
            typical_m = std::max(typical_m, rig.apart->background->median_depth_m());
        into.resize({target.width_px, target.height_px});
        FullscreenPass& pass = depth_[used_.size() - 1];
        Program& program = pass.use();
        bind_silhouettes(program, target);
        program.set("range_m", Eigen::Vector2f(static_cast<float>(nearest_share * typical_m),
                                               static_cast<float>(farthest_share * typical_m)));
        program.input("background_behind", background_behind
                                               ? *background_behind
                                               : used_.front().apart->background->depth());
        program.set("has_background", background_behind ? 1.0f : 0.0f);
        pass.draw(into.target());
    }

    const DepthPicture& lay_hull(const DepthPicture& set, const VirtualView& view) {
        find_depth(view, &set.depth_m(), hull_);
        for (std::size_t i = 0; i < used_.size(); ++i) {
            const DepthView& camera = used_[i].now->camera();
            const cv::Size size = used_[i].now->surface->colour().size();
            const cv::Size half((size.width + 1) / 2, (size.height + 1) / 2);
            const VirtualView own{
                half.width, half.height,
                scaled_intrinsics(camera.K, static_cast<double>(half.width) / size.width,
                                  static_cast<double>(half.height) / size.height),
                camera.world_from_camera};
            find_depth(own, nullptr, rig_hulls_[i]);
        }
        laid_.resize({view.width_px, view.height_px});
        FullscreenPass& pass = shade_[used_.size() - 1];
        Program& program = pass.use();
        bind_silhouettes(program, view);
        const Pose target_from_world = view.world_from_camera.inverse();
        for (std::size_t i = 0; i < used_.size(); ++i) {
            program.input("rig_hull", i, rig_hulls_[i].texture());
            program.input("colour", i, used_[i].now->surface->colour());
            program.set("centre", i,
                        Eigen::Vector3f((target_from_world *
                                         used_[i].now->camera().world_from_camera.translation())
                                            .cast<float>()));
        }
        program.input("hull", hull_.texture());
        program.input("background_colour", set.colour());
        program.input("background_behind", set.depth_m());
        program.set("ray_from_pixel", Eigen::Matrix3f(view.K.inverse().cast<float>()));
        pass.draw(laid_.target());
        return laid_;
    }

    LayerPass blend_background_;
    LayerBlender blender_;
    std::vector<FullscreenPass> depth_, shade_;  ///< one for every number of rigs
    std::vector<SeenRig> used_;
    DrawnTexture hull_{TextureFormat::r32f};
    std::array<DrawnTexture, most_rigs> rig_hulls_{
        DrawnTexture(TextureFormat::r32f), DrawnTexture(TextureFormat::r32f),
        DrawnTexture(TextureFormat::r32f), DrawnTexture(TextureFormat::r32f)};
    DepthPicture laid_;
};

}  // namespace

SynthesiserEntry hull_synthesiser_entry() {
    return {
        "hull", "foreground as the intersection of its silhouettes, shaded from the nearest rigs",
        [](const ShaderLibrary& library) { return std::make_unique<ForegroundPreparer>(library); },
        [](const ShaderLibrary& library) { return std::make_unique<HullRenderer>(library); },
        false};
}

}  // namespace vantage
