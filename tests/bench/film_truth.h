#pragma once

#include <string>
#include <vector>

#include "common/gl/shader_library.h"
#include "rig_firmware/stereo/matcher.h"
#include "tests/bench/film_scenes.h"

namespace vantage {

/// Generated films, played as a rig's: noise, JPEG, the rig's matcher, the host's preparation. The
/// virtual camera stands at a rig's own place and one baseline aside, where the right camera is the
/// truth.
struct FilmTruth {
    std::vector<FilmScene> scenes{all_film_scenes.begin(), all_film_scenes.end()};
    cv::Size size{320, 240};
    MatchPreset preset = MatchPreset::balanced;
    int rigs = 1;  ///< the second one four baselines to the right
    double rate_hz = 12, settling_s = 2, measured_s = 1;
    double noise_sigma = 2;  ///< grey levels
    int jpeg_quality = 90;
    bool has_background = true;  ///< false: every instant is foreground
    std::string pictures;  ///< a folder for the last pictures beside their truth; may be empty
};

/// A Markdown table, a row for each film. Needs a current context.
std::string film_table(const ShaderLibrary& library, const FilmTruth& wanted);

}  // namespace vantage
