#include <memory>

#include "rig_firmware/stereo/match_limits.h"
#include "rig_firmware/stereo/matcher.h"
#include "rig_firmware/stereo/passes/feature_pass.h"
#include "rig_firmware/stereo/passes/fill_pass.h"
#include "rig_firmware/stereo/passes/left_right_pass.h"
#include "rig_firmware/stereo/passes/perm_pass.h"
#include "rig_firmware/stereo/passes/result_pass.h"
#include "rig_firmware/stereo/passes/upsample_pass.h"

namespace vantage {
namespace {

/// The whole search range on the half-size pair (an eighth of the volume), then full-size edges.
class CoarseMatcher : public Matcher {
  public:
    CoarseMatcher(const ShaderLibrary& library, const MatchSettings& settings)
        : fill_unknown_(settings.fill),
          fine_{settings.width_px, settings.height_px},
          coarse_{(settings.width_px + 1) / 2, (settings.height_px + 1) / 2},
          fine_luma_(library, fine_),
          luma_(library, coarse_),
          features_(library, coarse_, sigma),
          perm_(library, coarse_, (settings.disparities + 1) / 2),
          check_(library, coarse_),
          fill_(library, coarse_),
          upsample_(library, coarse_, fine_),
          result_(library, fine_) {}

    const Texture& match(const Texture& left, const Texture& right) override {
        profiler_.begin_frame();
        fine_luma_.run(profiler_, left, right);
        luma_.run_halved(profiler_, fine_luma_);
        features_.run(profiler_, luma_);
        perm_.run(profiler_, features_);
        check_.run(profiler_, perm_.winners(), perm_.weight());
        if (fill_unknown_) fill_.run(profiler_, check_.disparity());
        upsample_.run(profiler_, fill_unknown_ ? fill_.filled() : check_.disparity(), luma_.left(),
                      fine_luma_.left());
        const Texture& result = result_.run(profiler_, upsample_.disparity());
        profiler_.end_frame();
        return result;
    }

    std::vector<PassReport> passes() const override { return profiler_.reports(); }
    void set_profiling(bool on) override { profiler_.set_enabled(on); }
    std::size_t cost_volume_bytes() const override { return perm_.volume_bytes(); }
    std::size_t gpu_bytes() const override {
        return fine_luma_.gpu_bytes() + upsample_.gpu_bytes() + luma_.gpu_bytes() +
               features_.gpu_bytes() + perm_.gpu_bytes() + check_.gpu_bytes() + fill_.gpu_bytes() +
               result_.gpu_bytes();
    }

  private:
    /// Grey levels of the guide over which a sum falls to 1/e.
    static constexpr double sigma = 12;

    bool fill_unknown_;
    StereoLayout fine_, coarse_;
    PassProfiler profiler_;
    LumaPass fine_luma_, luma_;
    FeaturePass features_;
    PermPass perm_;
    LeftRightPass check_;
    FillPass fill_;
    UpsamplePass upsample_;
    ResultPass result_;
};

}  // namespace

MatcherEntry coarse_matcher_entry() {
    return {"coarse", "perm on the half-size pair, snapped to the edges of the full-size picture",
            [](const ShaderLibrary& library,
               const MatchSettings& settings) -> std::unique_ptr<Matcher> {
                require_match_limits(settings);
                return std::make_unique<CoarseMatcher>(library, settings);
            }};
}

}  // namespace vantage
