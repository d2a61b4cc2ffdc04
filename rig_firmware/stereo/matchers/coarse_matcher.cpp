#include "rig_firmware/stereo/engine_matcher.h"
#include "rig_firmware/stereo/passes/perm_pass.h"
#include "rig_firmware/stereo/passes/sgm_pass.h"
#include "rig_firmware/stereo/passes/upsample_pass.h"

namespace vantage {
namespace {

StereoLayout halved_layout(const MatchSettings& settings) {
    return {(settings.width_px + 1) / 2, (settings.height_px + 1) / 2};
}

/// The whole search range on the half-size pair (an eighth of the volume), then full-size edges.
class CoarseMatcher : public EngineMatcher {
  public:
    CoarseMatcher(const ShaderLibrary& library, const MatchSettings& settings)
        : EngineMatcher(library, settings),
          fine_features_(library, layout_of(settings), sigma, settings.disparities),
          luma_(library, halved_layout(settings)),
          features_(library, halved_layout(settings), sigma, 0),
          perm_(library, halved_layout(settings), (settings.disparities + 1) / 2,
                PermOutput::costs),
          paths_(library, halved_layout(settings), (settings.disparities + 1) / 2,
                 {.p1 = 4, .p2 = 20, .columns = false}, perm_.large_scratch(),
                 perm_.small_scratch()),
          check_(library, halved_layout(settings), settings.fill),
          upsample_(library, halved_layout(settings), layout_of(settings)) {}

    std::size_t cost_volume_bytes() const override {
        return perm_.volume_bytes() + paths_.volume_bytes();
    }

  private:
    /// Grey levels of the guide over which a sum falls to 1/e.
    static constexpr double sigma = 6;

    const Buffer& search(PassProfiler& profiler, const LumaPass& fine_luma) override {
        fine_features_.run_words(profiler, fine_luma);
        luma_.run_halved(profiler, fine_luma, fine_features_.row_shift_votes());
        features_.run(profiler, luma_);
        perm_.run(profiler, features_);
        paths_.run(profiler, perm_.costs());
        upsample_.run(profiler, check_.run(profiler, paths_.winners(), nullptr), luma_.left(),
                      fine_luma.left(), fine_features_);
        return upsample_.disparity();
    }
    std::size_t search_bytes() const override {
        return fine_features_.gpu_bytes() + luma_.gpu_bytes() + features_.gpu_bytes() +
               perm_.gpu_bytes() + paths_.gpu_bytes() + check_.gpu_bytes() + upsample_.gpu_bytes();
    }

    FeaturePass fine_features_;
    LumaPass luma_;
    FeaturePass features_;
    PermPass perm_;
    SgmPass paths_;
    CheckAndFill check_;
    UpsamplePass upsample_;
};

}  // namespace

MatcherEntry coarse_matcher_entry() {
    return engine_entry<CoarseMatcher>(
        "coarse", "perm on the half-size pair, snapped to the edges of the full-size picture");
}

}  // namespace vantage
