#include "rig_firmware/stereo/matcher.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/gl/context/limits.h"

namespace vantage {

void MatchSettings::validate() const {
    if (disparities < 1 || disparities > max_disparities)
        fail("{} disparities asked for; a search has 1 to {}", disparities, max_disparities);
    if (width_px < 1 || height_px < 1 || width_px > max_side_px || height_px > max_side_px)
        fail("pictures of {}x{} cannot be matched: each side must be 1 to {} pixels", width_px,
             height_px, max_side_px);
}

void require_matcher(const std::string& name) {
    std::string known;
    for (const MatcherEntry& entry : matcher_entries()) {
        if (entry.name == name) return;
        known += (known.empty() ? "" : ", ") + entry.name;
    }
    fail("there is no matcher named '{}'; the ones there are: {}", name, known);
}

std::unique_ptr<Matcher> make_matcher(const std::string& name, const ShaderLibrary& library,
                                      const MatchSettings& settings) {
    settings.validate();
    require_matcher(name);
    const std::vector<MatcherEntry> entries = matcher_entries();
    return std::ranges::find(entries, name, &MatcherEntry::name)->make(library, settings);
}

MatchPreset parse_preset(const std::string& name) {
    if (name == "fast") return MatchPreset::fast;
    if (name == "balanced") return MatchPreset::balanced;
    if (name == "quality") return MatchPreset::quality;
    fail("there is no preset named '{}'; the ones there are: fast, balanced, quality", name);
}

std::string default_matcher(MatchPreset preset) {
    switch (preset) {
        case MatchPreset::fast:
        case MatchPreset::balanced:
            return "coarse";
        case MatchPreset::quality:
            return "row_pairs";
    }
    return "coarse";
}

void require_match_limits(const MatchSettings& settings) {
    constexpr int smallest_side_px = 16, most_disparities = 256;
    if (settings.width_px < smallest_side_px || settings.height_px < smallest_side_px ||
        settings.width_px > PiLimits::max_image_side_px ||
        settings.height_px > PiLimits::max_image_side_px)
        fail(
            "a pair of {}x{} cannot be matched: each side must be {} to {} pixels, so scale or "
            "crop it",
            settings.width_px, settings.height_px, smallest_side_px, PiLimits::max_image_side_px);
    if (settings.disparities < 1 || settings.disparities > most_disparities)
        fail(
            "a search range of {} disparities is not possible: give 1 to {}, or halve the pictures",
            settings.disparities, most_disparities);
}

}  // namespace vantage
