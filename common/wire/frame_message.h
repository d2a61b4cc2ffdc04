#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/shared_bytes.h"
#include "common/base/time/time.h"
#include "common/geometry/pose.h"
#include "common/geometry/rectified_stereo.h"
#include "common/image/image.h"

namespace vantage {

/// Milliseconds a frame spent in each stage of its rig.
struct RigStageTimes {
    float capture_ms = 0, rectify_ms = 0, match_ms = 0, pack_ms = 0;
};

/// What happened to the frames of a rig since its daemon started. Every pulse is in exactly one of
/// captured and missed; every captured frame ends in exactly one of late and published. What became
/// of a published frame on its way to one host is in that host's LinkCounters.
struct RigCounters {
    std::uint64_t captured = 0;      ///< delivered by the source
    std::uint64_t missed = 0;        ///< pulses or sequence numbers for which no frame came
    std::uint64_t late = 0;          ///< dropped because a stage was still busy
    std::uint64_t published = 0;     ///< handed to the publisher (which fills this in)
    std::uint64_t send_dropped = 0;  ///< dropped for slow hosts, all hosts together (likewise)

    bool operator==(const RigCounters&) const = default;
};

/// How a rig stands to the stage's clock and pulses.
struct RigSync {
    enum class Role { free, lead, follow };
    Role role = Role::free;
    bool ready = false;                ///< stands and waits for the first pulse, or is past it
    std::uint64_t first_pulse = 0;     ///< from which on it has pulses; 0: none announced
    std::uint64_t pulses = 0;          ///< lead: sent; follow: seen
    std::uint64_t skipped = 0;         ///< lead: would have been too late; follow: no edge came
    std::uint64_t unsynchronized = 0;  ///< frames without a pulse of their own
    float lateness_p50_us = 0, lateness_p99_us = 0, lateness_max_us = 0;
    double clock_ppm = 0;           ///< of the sensors' clock over the stage's
    std::uint64_t clock_steps = 0;  ///< times that its clock was set since it started
    double clock_step_ms = 0;       ///< by so much the last time; above 0: forward
    bool disciplined = false;       ///< by PTP; false: the next two say nothing
    double ptp_offset_ns = 0, ptp_path_delay_ns = 0;
    std::string ptp_state;  ///< of ptp4l's port, such as "SLAVE"; empty: no ptp4l
    int tai_offset_s = 0;   ///< of its CLOCK_TAI from UTC
    double rate_hz = 0;     ///< of pulses, as the rig was told; 0: it does not say

    bool operator==(const RigSync&) const = default;
};

/// What happened to the published frames on their way to one host, counted by the rig. Every
/// offered frame is in exactly one of sent, send_dropped, thinned, or still in the host's bounded
/// queue.
struct LinkCounters {
    std::uint64_t offered = 0;       ///< published while the host was attached
    std::uint64_t sent = 0;          ///< handed to the socket
    std::uint64_t send_dropped = 0;  ///< pushed out of the queue by newer ones, or left in it when
                                     ///< the host went away
    std::uint64_t skipped = 0;       ///< left out as the host asked

    bool operator==(const LinkCounters&) const = default;
};

struct PackedFrame;

/// One published instant of one rig, decoded: what the host gets, what the rig packs.
struct RigFrame {
    enum class Content {
        view,     ///< the rectified left picture and its disparity
        raw_pair  ///< both pictures as the sensors gave them, for calibration: of `geometry` only
                  ///< the size, no pose and no disparity
    };
    Content content = Content::view;
    std::string rig;
    std::uint64_t session = 0;  ///< random per start of the daemon
    bool synchronized = false;  ///< false: trigger_index names no pulse of the stage
    std::uint64_t trigger_index = 0;
    TaiTime exposure{};  ///< centre of exposure
    TaiTime published{};
    std::string calibration_id;
    RectifiedStereo geometry;                   ///< of the colour picture
    Pose world_from_camera = Pose::Identity();  ///< camera = rectified left
    bool place_is_assumed = false;  ///< as StereoCalibration's: nobody said where the rig stands
    ColourImage colour;             ///< rectified left picture, may be empty; or the raw left one
    /// At a rig: of a view the rectified right picture where it is to travel, beside a JPEG only;
    /// of a raw pair the raw right one. Of the colour's size. At a host: of a raw pair.
    ColourImage right;
    /// At a host: the rectified right picture, not decoded yet, the newest that came.
    SharedBytes right_jpeg;
    /// At a rig: colour as it travels, where a ColourPacker packed it ahead, and how much of it is
    /// the right picture.
    std::vector<std::byte> packed_colour;
    std::size_t packed_right_bytes = 0;
    /// At a host: the frame as it came; null: it came over no wire.
    std::shared_ptr<const PackedFrame> packed;
    DisparityImage
        disparity;  ///< left-referenced, in px of its own width (may be smaller than the colour's)
    float max_disparity_px = 0;
    RigStageTimes times;
    RigCounters counters;
    RigSync sync;

    /// False at a host for what nobody looks at: `packed` has them.
    bool has_pictures() const { return !colour.empty() || !disparity.empty(); }
};

}  // namespace vantage
