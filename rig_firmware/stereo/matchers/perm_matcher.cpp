#include <memory>

#include "rig_firmware/stereo/match_limits.h"
#include "rig_firmware/stereo/matcher.h"
#include "rig_firmware/stereo/passes/feature_pass.h"
#include "rig_firmware/stereo/passes/fill_pass.h"
#include "rig_firmware/stereo/passes/left_right_pass.h"
#include "rig_firmware/stereo/passes/perm_pass.h"
#include "rig_firmware/stereo/passes/result_pass.h"

namespace vantage {
namespace {

/// Census and gradient cost, permeability aggregation over the whole search range.
class PermMatcher : public Matcher {
  public:
    PermMatcher(const ShaderLibrary& library, const MatchSettings& settings)
        : fill_unknown_(settings.fill),
          layout_{settings.width_px, settings.height_px},
          luma_(library, layout_),
          features_(library, layout_, sigma),
          perm_(library, layout_, settings.disparities),
          check_(library, layout_),
          fill_(library, layout_),
          result_(library, layout_) {}

    const Texture& match(const Texture& left, const Texture& right) override {
        profiler_.begin_frame();
        luma_.run(profiler_, left, right);
        features_.run(profiler_, luma_);
        perm_.run(profiler_, features_);
        check_.run(profiler_, perm_.winners(), perm_.weight());
        if (fill_unknown_) fill_.run(profiler_, check_.disparity());
        const Texture& result =
            result_.run(profiler_, fill_unknown_ ? fill_.filled() : check_.disparity());
        profiler_.end_frame();
        return result;
    }

    std::vector<PassReport> passes() const override { return profiler_.reports(); }
    void set_profiling(bool on) override { profiler_.set_enabled(on); }
    std::size_t cost_volume_bytes() const override { return perm_.volume_bytes(); }
    std::size_t gpu_bytes() const override {
        return luma_.gpu_bytes() + features_.gpu_bytes() + perm_.gpu_bytes() + check_.gpu_bytes() +
               fill_.gpu_bytes() + result_.gpu_bytes();
    }

  private:
    /// Grey levels of the guide over which a sum falls to 1/e.
    static constexpr double sigma = 12;

    bool fill_unknown_;
    StereoLayout layout_;
    PassProfiler profiler_;
    LumaPass luma_;
    FeaturePass features_;
    PermPass perm_;
    LeftRightPass check_;
    FillPass fill_;
    ResultPass result_;
};

}  // namespace

MatcherEntry perm_matcher_entry() {
    return {"perm", "census and gradient cost, permeability aggregation over the whole range",
            [](const ShaderLibrary& library,
               const MatchSettings& settings) -> std::unique_ptr<Matcher> {
                require_match_limits(settings);
                return std::make_unique<PermMatcher>(library, settings);
            }};
}

}  // namespace vantage
