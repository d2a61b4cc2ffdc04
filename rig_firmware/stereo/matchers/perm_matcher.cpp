#include "rig_firmware/stereo/engine_matcher.h"
#include "rig_firmware/stereo/volume/perm_pass.h"

namespace vantage {
namespace {

/// Census, gradient and colour cost, permeability aggregation over the whole search range.
class PermMatcher : public EngineMatcher {
  public:
    PermMatcher(const ShaderLibrary& library, const MatchSettings& settings)
        : EngineMatcher(library, settings),
          features_(library, layout_of(settings), settings.disparities, picture_kind(settings)),
          permeability_(library, layout_of(settings), sigma),
          perm_(library, layout_of(settings), settings.disparities),
          check_(library, layout_of(settings), fill_at_full_size(settings)) {}

    std::size_t cost_volume_bytes() const override { return perm_.volume_bytes(); }

  private:
    /// Grey levels of the guide over which a sum falls to 1/e.
    static constexpr double sigma = 12;

    const Buffer& search(PassProfiler& profiler, const LumaPass& luma) override {
        features_.run(profiler, luma);
        permeability_.run(profiler, luma.left());
        perm_.run(profiler, features_, permeability_);
        return check_.run(profiler, luma.left(), perm_.winners(), &perm_.weight());
    }
    void forget_search() override { features_.forget(); }
    std::size_t search_bytes() const override {
        return features_.gpu_bytes() + permeability_.gpu_bytes() + perm_.gpu_bytes() +
               check_.gpu_bytes();
    }

    FeaturePass features_;
    PermeabilityPass permeability_;
    PermPass perm_;
    CheckAndFill check_;
};

}  // namespace

MatcherEntry perm_matcher_entry() {
    return engine_entry<PermMatcher>(
        "perm", "census, gradient and colour cost, permeability aggregation over the whole range");
}

}  // namespace vantage
