#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vantage {

/// The configuration of a rig (rig.toml). hw_config/rig.toml documents every key. Unknown keys,
/// wrong types and values out of range are errors that name file, line and the nearest known key.
struct RigConfig {
    std::filesystem::path file;  ///< the file it was loaded from; empty: none
    std::string name;            ///< unique on the stage; default: this computer's host name

    struct Source {
        std::string kind = "virtual";  ///< virtual | files | v4l2 | libcamera
        double rate_hz = 30;           ///< trigger rate
        // virtual
        int width_px = 320, height_px = 240;
        std::uint64_t seed = 1;  ///< for sensor noise
        double noise_sigma = 0;  ///< sensor noise, 8-bit grey levels
        // files
        std::string left = "", right = "";  ///< single images, numbered ones (%d, %04d), shell
                                            ///< patterns, folders or videos
        bool side_by_side = false;          ///< `left` holds both images side by side
        int first = 0;                      ///< first number of a pattern
        int frames = 0;  ///< most pairs of a series or video that are shown; 0: all
        bool loop = true;
        // v4l2
        std::string left_device = "", right_device = "";  ///< right empty: a side-by-side device
        std::string pixel_format = "";             ///< fourcc; empty: the best of the known ones
        std::string buffers = "auto";              ///< auto | import (into the GPU) | copy
        std::map<std::string, int> controls = {};  ///< by the driver's control name
        // libcamera, which also uses the keys of v4l2 above, except the controls
        double exposure_us = 5000, analogue_gain = 1, red_gain = 1, blue_gain = 1;
    } source;

    std::filesystem::path
        calibration;  ///< YAML; may be empty for the virtual source and for rectified files
    bool uncalibrated = false;  ///< calibration = "none": the rig serves raw pairs only

    /// An ideal, already rectified rig. The virtual source films with it unless a calibration is
    /// given, and rectified files without a calibration are taken to come from it.
    struct VirtualRig {
        double azimuth_deg = 0, elevation_deg = 10, distance_m = 4.5, baseline_m = 0.12,
               field_of_view_deg = 50;
        double doffs_px = 0;      ///< cx_right - cx_left; for files only
        int scene = 0;            ///< of the virtual stage; 0: the studio, others are generated
        double loop_mb = 64;      ///< memory for rendered pairs of the stage's loop; virtual only
        bool loop_ahead = false;  ///< render the whole loop before the first pulse; virtual only
        int bar_leds = 0;         ///< of an LED bar in every frame; 0: none
        double bar_step_us = 127;
        double left_skew_us = 0, right_skew_us = 0;  ///< from the pulse to the sensor's exposure
    } virtual_rig;

    struct Trigger {
        std::string role = "free";         ///< lead | follow | free
        std::string chip = "", line = "";  ///< label of the GPIO chip, name of its line
        int line_offset = -1;              ///< instead of a name
        bool active_low = true;            ///< whether a pulse is the low level
        bool pretended = false;            ///< no line: timing only
        std::string start = "host";        ///< for lead: host | at_once
        std::string sensor = "other";      ///< model, with defaults for the next two
        double exposure_us = 5000;
        double exposure_offset_us = -1;  ///< exposure minus pulse width; below 0: the model's
        double readout_us = -1;          ///< below 0: the model's
        double timestamp_delay_us = -1;  ///< sensor time minus pulse; below 0: the exposure
        double late_limit_us = 1000;     ///< a pulse later than this is skipped
        double spin_us = 0;              ///< busy waiting before each edge
        int realtime_priority = 60;      ///< SCHED_FIFO; 0: none
    } trigger;

    struct Match {
        std::string
            matcher;  ///< empty: the preset's default; "exact": the virtual stage's true depth
        std::string preset = "balanced";  ///< fast | balanced | quality | auto: the best one that
                                          ///< holds the source's rate with a margin of a third
        int width_px = 0;  ///< of the pictures that are matched; 0: that of the colour picture
        int disparities = 64;
        bool fill = true;
        bool steady = true;  ///< temporal denoising where nothing moves
    } match;

    struct Stream {
        std::string bind = "tcp://127.0.0.1:5600";
        std::string road = "tcp";      ///< of frames: tcp | srt, with tcp where srt does not work
        int jpeg_quality = 82;         ///< 1..100; 0: lossless colour
        std::string chroma = "4:2:0";  ///< of JPEG: 4:4:4 | 4:2:2 | 4:2:0
        int queue_frames = 4;  ///< frames that may wait for one host before the oldest is dropped
        std::filesystem::path key_file;  ///< this rig's CURVE key pair; needed beyond loopback
        std::filesystem::path
            authorized_hosts;  ///< public keys of the admitted hosts, one per line
    } stream;

    struct Keep {
        std::filesystem::path folder;        ///< for the rig's own recordings; empty: none
        double hours = 24, gigabytes = 100;  ///< beyond either, the oldest files are deleted
        double minutes = 5;                  ///< per file
    } keep;
};

/// Throws Error with file and line for an invalid file.
RigConfig load_rig_config(const std::filesystem::path& path);

}  // namespace vantage
