#pragma once

#include <cstdint>
#include <string>

#include "common/base/time.h"
#include "common/geometry/pose.h"
#include "common/geometry/rectified_stereo.h"
#include "common/image/image.h"

namespace vantage {

/// Milliseconds a frame spent in each stage of its rig.
struct RigStageTimes {
    float capture_ms = 0, rectify_ms = 0, match_ms = 0, pack_ms = 0;
};

/// What happened to the frames of a rig since its daemon started. Every frame that was triggered is
/// in exactly one of: published, missed, late, send_dropped.
struct RigCounters {
    std::uint64_t captured = 0;      ///< delivered by the source
    std::uint64_t missed = 0;        ///< pulses or sequence numbers for which no frame came
    std::uint64_t late = 0;          ///< dropped because a stage was still busy
    std::uint64_t published = 0;     ///< handed to the socket
    std::uint64_t send_dropped = 0;  ///< refused by the socket's bounded queue
};

/// One published instant of one rig, decoded: what the host gets, what the rig packs.
struct RigFrame {
    std::string rig;
    std::uint64_t session = 0;  ///< random per start of the daemon
    bool synchronized = false;  ///< false: trigger_index names no pulse of the stage
    std::uint64_t trigger_index = 0;
    TaiTime exposure{};  ///< centre of exposure
    TaiTime published{};
    std::string timecode;  ///< SMPTE 12M "hh:mm:ss:ff"
    std::string calibration_id;
    RectifiedStereo geometry;                   ///< of the colour picture
    Pose world_from_camera = Pose::Identity();  ///< camera = rectified left
    ColourImage colour;                         ///< rectified left picture
    DisparityImage
        disparity;  ///< left-referenced, in px of its own width (may be smaller than the colour's)
    float max_disparity_px = 0;
    RigStageTimes times;
    RigCounters counters;
};

}  // namespace vantage
