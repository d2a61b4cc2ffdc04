#include "rig_firmware/stereo/disparity/streak_pass.h"
#include "rig_firmware/stereo/engine_matcher.h"
#include "rig_firmware/stereo/volume/perm_cost_pass.h"
#include "rig_firmware/stereo/volume/perm_pass.h"
#include "rig_firmware/stereo/volume/sgm_pass.h"

namespace vantage {
namespace {

/// Permeability aggregation, whose normalised sums are the costs of a light semi-global matching
/// along the rows.
class PermSgmMatcher : public EngineMatcher {
  public:
    PermSgmMatcher(const ShaderLibrary& library, const MatchSettings& settings)
        : EngineMatcher(library, settings),
          features_(library, layout_of(settings), settings.disparities, picture_kind(settings)),
          permeability_(library, layout_of(settings), sigma),
          perm_(library, layout_of(settings), settings.disparities, PermOutput::costs,
                costs_first() ? PermCosts::given : PermCosts::found),
          paths_(library, layout_of(settings), settings.disparities,
                 {.p1 = 5, .p2 = 26, .columns = false}, perm_.large_scratch(),
                 perm_.small_scratch()),
          streaks_(library, layout_of(settings), settings.disparities),
          check_(library, layout_of(settings), fill_at_full_size(settings)) {
        if (costs_first()) cost_.emplace(library, layout_of(settings), settings.disparities);
    }

    std::size_t cost_volume_bytes() const override {
        return perm_.volume_bytes() + paths_.volume_bytes();
    }

  private:
    /// Smaller than where permeability has to smooth alone: paths do the rest.
    static constexpr double sigma = 8;
    /// Whether costs go through memory once before they are aggregated: a Raspberry Pi's GPU has
    /// too few registers to compute them within the aggregation.
    static bool costs_first() { return lane_mapping_here() == LaneMapping::disparities; }

    const Buffer& search(PassProfiler& profiler, const LumaPass& luma) override {
        features_.run(profiler, luma);
        permeability_.run(profiler, luma.left());
        if (cost_) {
            cost_->run(profiler, features_, perm_.costs());
            perm_.run(profiler, permeability_);
        } else {
            perm_.run(profiler, features_, permeability_);
        }
        paths_.run(profiler, perm_.costs());
        streaks_.run(profiler, check_.check(profiler, paths_.winners(), nullptr), perm_.costs());
        return check_.fill(profiler, luma.left());
    }
    void forget_search() override { features_.forget(); }
    std::size_t search_bytes() const override {
        return features_.gpu_bytes() + permeability_.gpu_bytes() + perm_.gpu_bytes() +
               paths_.gpu_bytes() + check_.gpu_bytes();
    }

    FeaturePass features_;
    PermeabilityPass permeability_;
    std::optional<PermCostPass> cost_;
    PermPass perm_;
    SgmPass paths_;
    StreakPass streaks_;
    CheckAndFill check_;
};

}  // namespace

MatcherEntry perm_sgm_matcher_entry() {
    return engine_entry<PermSgmMatcher>("perm_sgm",
                                        "perm, then semi-global matching along the rows");
}

}  // namespace vantage
