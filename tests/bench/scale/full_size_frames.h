#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/rig_config.h"
#include "common/gl/shader_library.h"
#include "common/wire/frame_codec.h"

namespace vantage {

/// What rigs of full size film.
struct FullSizeFrames {
    std::string colour = "1456x1088", depth = "640x400";
    double noise_sigma = 1;  ///< of the sensors, grey levels
    std::string chroma = RigConfig::Stream{}.chroma;
    int jpeg_quality = RigConfig::Stream{}.jpeg_quality, disparities = 64, instants = 3;
};

/// One rig's frames at a few moments of the virtual stage, as they travel: synchronized, of pulses
/// 1, 2, ..., with the depth of the rig's own matcher.
std::vector<PackedFrame> film_full_size(const ShaderLibrary& library, const FullSizeFrames& wanted,
                                        double azimuth_deg, std::uint64_t seed);

}  // namespace vantage
