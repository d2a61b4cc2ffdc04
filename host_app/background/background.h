#pragma once

#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/image/image.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// What one rig has learnt of its set.
struct RigBackground {
    std::string rig;
    std::string calibration;  ///< calibration_of() its camera
    /// Alpha, and the depth's certainty: how much of the longest mean each is of, 0..255.
    ColourImage colour;
    DepthImage depth_m;  ///< 0 = unknown
    cv::Mat1b certainty;
};

/// The set of a stage: colour, depth and certainty, as every rig sees it.
struct Background {
    TaiTime learnt{};
    std::vector<RigBackground> rigs;
};

/// The checksum of all that places a rig's pixels in the world: "fnv1a64:" and 16 digits.
std::string calibration_of(const DepthView& camera, cv::Size colour_size, cv::Size depth_size);

/// How a rig stands to its set.
struct RigBackgroundState {
    std::string rig;
    double known = 0;        ///< share of its pixels that have been still for half a second
    bool is_loaded = false;  ///< it began with a set that was learnt before
    std::string misfit;      ///< why it did not, though there is one; a sentence
    cv::Mat1b matte = {};    ///< the performers' share of its picture, small, 0..255
};

}  // namespace vantage
