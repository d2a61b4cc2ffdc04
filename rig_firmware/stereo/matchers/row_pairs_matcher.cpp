#include "rig_firmware/stereo/disparity/streak_pass.h"
#include "rig_firmware/stereo/disparity/upsample_pass.h"
#include "rig_firmware/stereo/engine_matcher.h"
#include "rig_firmware/stereo/features/halve_pass.h"
#include "rig_firmware/stereo/volume/perm_cost_pass.h"
#include "rig_firmware/stereo/volume/perm_pass.h"
#include "rig_firmware/stereo/volume/sgm_pass.h"

namespace vantage {
namespace {

/// The whole search range and every column on half of the rows (half the volume), with the costs of
/// all rows; then full-size edges.
class RowPairsMatcher : public EngineMatcher {
  public:
    RowPairsMatcher(const ShaderLibrary& library, const MatchSettings& settings)
        : RowPairsMatcher(library, settings, layout_of(settings),
                          with_half_the_rows(layout_of(settings))) {}

    std::size_t cost_volume_bytes() const override {
        return perm_.volume_bytes() + paths_.volume_bytes();
    }

  private:
    /// Grey levels of the guide over which a sum falls to 1/e.
    static constexpr double sigma = 5;

    static DisparityForm result_form(const MatchSettings& settings) {
        return settings.confidence ? DisparityForm::words : DisparityForm::halves;
    }

    RowPairsMatcher(const ShaderLibrary& library, const MatchSettings& settings,
                    const StereoLayout& fine, const StereoLayout& coarse)
        : EngineMatcher(library, settings, result_form(settings)),
          features_(library, fine, settings.disparities, picture_kind(settings)),
          halve_(library, fine, HalvedSides::height),
          permeability_(library, coarse, sigma, PermeabilityGuide::median),
          cost_(library, fine, settings.disparities, CostRows::pairs),
          perm_(library, coarse, settings.disparities, PermOutput::costs, PermCosts::given),
          paths_(library, coarse, settings.disparities, {.p1 = 6, .p2 = 30, .columns = false},
                 perm_.large_scratch(), perm_.small_scratch()),
          streaks_(library, coarse, settings.disparities),
          check_(library, coarse, settings.fill ? Fill::along_paths_of_one_px : Fill::none),
          upsample_(library, fine, result_form(settings)) {}

    const Buffer& search(PassProfiler& profiler, const LumaPass& luma) override {
        features_.run(profiler, luma);
        halve_.run(profiler, luma.left());
        permeability_.run(profiler, halve_.luma());
        cost_.run(profiler, features_, perm_.costs());
        perm_.run(profiler, permeability_);
        paths_.run(profiler, perm_.costs());
        streaks_.run(profiler, check_.check(profiler, paths_.winners(), nullptr), perm_.costs());
        upsample_.run(profiler, check_.fill(profiler, halve_.luma()), halve_.luma(), luma.left());
        return upsample_.disparity();
    }
    void forget_search() override { features_.forget(); }
    std::size_t search_bytes() const override {
        return features_.gpu_bytes() + halve_.gpu_bytes() + permeability_.gpu_bytes() +
               perm_.gpu_bytes() + paths_.gpu_bytes() + check_.gpu_bytes() + upsample_.gpu_bytes();
    }

    FeaturePass features_;
    HalvePass halve_;
    PermeabilityPass permeability_;
    PermCostPass cost_;
    PermPass perm_;
    SgmPass paths_;
    StreakPass streaks_;
    CheckAndFill check_;
    UpsampleRowsPass upsample_;
};

}  // namespace

MatcherEntry row_pairs_matcher_entry() {
    return engine_entry<RowPairsMatcher>(
        "row_pairs", "perm_sgm on half of the rows, snapped to the edges of the picture");
}

}  // namespace vantage
