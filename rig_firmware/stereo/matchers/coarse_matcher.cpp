#include <algorithm>

#include "rig_firmware/stereo/disparity/upsample_pass.h"
#include "rig_firmware/stereo/engine_matcher.h"
#include "rig_firmware/stereo/features/halve_pass.h"
#include "rig_firmware/stereo/volume/halved_cost_pass.h"
#include "rig_firmware/stereo/volume/perm_pass.h"
#include "rig_firmware/stereo/volume/sgm_pass.h"

namespace vantage {
namespace {

/// The whole search range on a grid of half the size (an eighth of the volume), with the costs of
/// full-size pixels; then full-size edges.
class CoarseMatcher : public EngineMatcher {
  public:
    CoarseMatcher(const ShaderLibrary& library, const MatchSettings& settings)
        : CoarseMatcher(library, settings, layout_of(settings), halved(layout_of(settings)),
                        halved_disparities(settings.disparities), path_settings(settings.preset)) {}

    std::size_t cost_volume_bytes() const override {
        return perm_.volume_bytes() + paths_.volume_bytes();
    }

  private:
    /// Grey levels of the guide over which a sum falls to 1/e.
    static constexpr double sigma = 7.5;
    /// Two paths along the rows. Two more along the columns take 3 ms of a Raspberry Pi 5 and
    /// change the errors by less than a twentieth.
    static SgmSettings path_settings(MatchPreset preset) {
        return {.p1 = 6, .p2 = preset == MatchPreset::fast ? 20 : 16, .columns = false};
    }

    /// `fast` compares one sample of each 2x2, the others two.
    static HalvedCostSamples samples_of(const MatchSettings& settings) {
        return settings.preset == MatchPreset::fast ? HalvedCostSamples::one
                                                    : HalvedCostSamples::two;
    }
    static DisparityForm result_form(const MatchSettings& settings) {
        return settings.confidence ? DisparityForm::words : DisparityForm::halves;
    }

    /// `fast` has no time for paths.
    static Fill fill_of(const MatchSettings& settings) {
        if (!settings.fill) return Fill::none;
        return settings.preset == MatchPreset::fast ? Fill::along_rows
                                                    : Fill::along_paths_of_one_px;
    }

    CoarseMatcher(const ShaderLibrary& library, const MatchSettings& settings,
                  const StereoLayout& fine, const StereoLayout& coarse, int coarse_disparities,
                  const SgmSettings& paths)
        : EngineMatcher(library, settings, result_form(settings)),
          features_(library, fine, settings.disparities, picture_kind(settings),
                    samples_of(settings) == HalvedCostSamples::one ? FeatureRows::one_of_two
                                                                   : FeatureRows::all),
          halve_(library, fine),
          permeability_(library, coarse, sigma, PermeabilityGuide::plain),
          cost_(library, fine, settings.disparities, samples_of(settings)),
          perm_(library, coarse, coarse_disparities, PermOutput::costs, PermCosts::given,
                std::min(paths.most_cost(), max_perm_code)),
          paths_(library, coarse, coarse_disparities, paths, perm_.large_scratch(),
                 perm_.small_scratch()),
          check_(library, coarse, fill_of(settings), Valley::flat, disparity_steps_per_px / 2),
          upsample_(library, coarse, fine, result_form(settings)) {}

    const Buffer& search(PassProfiler& profiler, const LumaPass& luma) override {
        features_.run(profiler, luma);
        halve_.run(profiler, luma.left());
        permeability_.run(profiler, halve_.luma());
        cost_.run(profiler, features_, perm_.costs());
        perm_.run(profiler, permeability_);
        paths_.run(profiler, perm_.costs());
        upsample_.run(profiler, check_.run(profiler, halve_.luma(), paths_.winners(), nullptr),
                      halve_.luma(), luma.left());
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
    HalvedCostPass cost_;
    PermPass perm_;
    SgmPass paths_;
    CheckAndFill check_;
    UpsamplePass upsample_;
};

}  // namespace

MatcherEntry coarse_matcher_entry() {
    return engine_entry<CoarseMatcher>(
        "coarse", "perm_sgm on a grid of half the size, snapped to the edges of the picture");
}

}  // namespace vantage
