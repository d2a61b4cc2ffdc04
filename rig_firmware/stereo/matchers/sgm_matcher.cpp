#include "rig_firmware/stereo/engine_matcher.h"
#include "rig_firmware/stereo/volume/sgm_pass.h"

namespace vantage {
namespace {

/// Census and gradient cost, semi-global matching along four paths.
class SgmMatcher : public EngineMatcher {
  public:
    SgmMatcher(const ShaderLibrary& library, const MatchSettings& settings)
        : EngineMatcher(library, settings),
          features_(library, layout_of(settings), settings.disparities, picture_kind(settings)),
          cost_(library, layout_of(settings), settings.disparities, 1),
          paths_(library, layout_of(settings), settings.disparities, {.p1 = 7, .p2 = 50}),
          check_(library, layout_of(settings), fill_at_full_size(settings)) {}

    std::size_t cost_volume_bytes() const override {
        return cost_.costs().bytes() + paths_.volume_bytes();
    }

  private:
    const Buffer& search(PassProfiler& profiler, const LumaPass& luma) override {
        features_.run(profiler, luma);
        cost_.run(profiler, features_);
        paths_.run(profiler, cost_.costs());
        return check_.run(profiler, luma.left(), paths_.winners(), nullptr);
    }
    void forget_search() override { features_.forget(); }
    std::size_t search_bytes() const override {
        return features_.gpu_bytes() + cost_.costs().bytes() + paths_.gpu_bytes() +
               check_.gpu_bytes();
    }

    FeaturePass features_;
    SgmCostPass cost_;
    SgmPass paths_;
    CheckAndFill check_;
};

}  // namespace

MatcherEntry sgm_matcher_entry() {
    return engine_entry<SgmMatcher>("sgm",
                                    "census, gradient and colour cost, semi-global, four paths");
}

}  // namespace vantage
