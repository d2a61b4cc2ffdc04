#pragma once

#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/image/image.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// The background of one rig, as learnt over time.
struct RigBackground {
    std::string rig;
    std::string calibration;  ///< calibration_of() its camera
    ColourImage colour;       ///< alpha: certainty of the colour, 0..255 of the longest mean
    DepthImage depth_m;       ///< 0 = unknown
    cv::Mat1b certainty;      ///< of the depth, 0..255 of the longest mean
};

/// The background of a stage: colour, depth and certainty, as each rig sees it.
struct Background {
    TaiTime learnt{};
    std::vector<RigBackground> rigs;
};

/// The state of a rig's background, for operators.
struct RigBackgroundState {
    std::string rig;
    double known = 0;        ///< share of its pixels whose background is known
    bool is_loaded = false;  ///< it began with a loaded background
    std::string misfit;      ///< a sentence: why the loaded background does not fit; else empty
    cv::Mat1b matte = {};    ///< reduced matte of the newest instant, 0..255
};

}  // namespace vantage
