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

/// Milliseconds that a frame spent in each stage of its rig.
struct RigStageTimes {
    float capture_ms = 0, rectify_ms = 0, match_ms = 0, pack_ms = 0;
};

/// Counts of a rig's frames since its daemon started. Every pulse is either captured or missed;
/// every captured frame is in the end either late or published. LinkCounters count the fate of
/// published frames per host.
struct RigCounters {
    std::uint64_t captured = 0;   ///< delivered by the frame source
    std::uint64_t missed = 0;     ///< pulses or sequence numbers without a frame
    std::uint64_t late = 0;       ///< dropped because a stage was still busy
    std::uint64_t published = 0;  ///< given to the publisher, which counts this
    std::uint64_t send_dropped =
        0;  ///< dropped for slow hosts, summed over hosts, by the publisher

    bool operator==(const RigCounters&) const = default;
};

/// The state of a rig's clock and trigger.
struct RigSync {
    enum class Role { free, lead, follow };
    Role role = Role::free;
    bool ready = false;                ///< waits for the first pulse, or is past it
    std::uint64_t first_pulse = 0;     ///< first pulse of the stage; 0: none announced
    std::uint64_t pulses = 0;          ///< lead: sent; follow: seen
    std::uint64_t skipped = 0;         ///< lead: would have been too late; follow: no edge came
    std::uint64_t unsynchronized = 0;  ///< frames without a pulse
    float lateness_p50_us = 0, lateness_p99_us = 0, lateness_max_us = 0;
    double clock_ppm = 0;           ///< rate of the sensors' clock relative to the stage's
    std::uint64_t clock_steps = 0;  ///< times that the clock was set since its start
    double clock_step_ms = 0;       ///< size of the last step; positive: forward
    bool disciplined = false;       ///< by PTP; if false, the next two are meaningless
    double ptp_offset_ns = 0, ptp_path_delay_ns = 0;
    std::string ptp_state;  ///< of ptp4l's port: "SLAVE" etc.; empty: no ptp4l
    int tai_offset_s = 0;   ///< CLOCK_TAI minus UTC
    double rate_hz = 0;     ///< configured trigger rate; 0: not reported

    bool operator==(const RigSync&) const = default;
};

/// Counts of the published frames on their way to one host, counted by the rig. Every offered frame
/// is sent, send_dropped, skipped, or still in the host's bounded queue.
struct LinkCounters {
    std::uint64_t offered = 0;       ///< published while the host was attached
    std::uint64_t sent = 0;          ///< handed to the socket
    std::uint64_t send_dropped = 0;  ///< dropped from the queue for newer ones, or when the host
                                     ///< disconnected
    std::uint64_t skipped = 0;       ///< not requested by the host

    bool operator==(const LinkCounters&) const = default;
};

struct PackedFrame;

/// One decoded frame of a rig: the input of the rig's encoder and the output of the host's decoder.
struct RigFrame {
    enum class Content {
        view,     ///< the rectified left image and its disparity
        raw_pair  ///< both sensor images, for calibration: `geometry` has only a size; no pose,
                  ///< no disparity
    };
    Content content = Content::view;
    std::string rig;
    std::uint64_t session = 0;  ///< random per start of the daemon
    bool synchronized = false;  ///< false: trigger_index is not a pulse of the stage
    std::uint64_t trigger_index = 0;
    TaiTime exposure{};  ///< centre of the exposure
    TaiTime published{};
    std::string calibration_id;
    RectifiedStereo geometry;                   ///< of the colour image
    Pose world_from_camera = Pose::Identity();  ///< of the rectified left camera
    bool place_is_assumed = false;              ///< see StereoCalibration
    ColourImage colour;  ///< rectified left image, may be empty; or the raw left one
    /// Of the colour's size. At a rig: the rectified right image of a view that is to be sent,
    /// beside a JPEG only, or the raw right image. At a host: the raw right image.
    ColourImage right;
    /// At a host: the newest rectified right image that came, not decoded.
    SharedBytes right_jpeg;
    /// At a rig: colour packed early by a ColourPacker, and the size of the right image in it.
    std::vector<std::byte> packed_colour;
    std::size_t packed_right_bytes = 0;
    /// At a host: the frame as received; null: not from the network.
    std::shared_ptr<const PackedFrame> packed;
    DisparityImage
        disparity;  ///< left-referenced, in px of its own width (may be smaller than the colour's)
    float max_disparity_px = 0;
    RigStageTimes times;
    RigCounters counters;
    RigSync sync;

    /// False at a host for frames that were not decoded; `packed` has their images.
    bool has_pictures() const { return !colour.empty() || !disparity.empty(); }
};

}  // namespace vantage
