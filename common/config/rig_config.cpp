#include "common/config/rig_config.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <unistd.h>

#include "common/config/stream_keys.h"
#include "common/config/toml_reader.h"

namespace vantage {
namespace {

constexpr int rig_config_version = 1;

/// Returns the first label of this computer's host name in the characters of a rig's name, or an
/// empty string. Rigs that run the installed file unchanged then have different names.
std::string computer_name() {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) return "";
    std::string name(host.data());
    name.resize(std::min(name.find('.'), name.size()));
    std::erase_if(name, [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_'; });
    return name;
}

void read_source(TomlTable& table, RigConfig::Source& source) {
    table.read("kind", source.kind);
    table.read("rate_hz", source.rate_hz, {0.01, 1000});
    table.read("width_px", source.width_px, {16, 4096});
    table.read("height_px", source.height_px, {16, 4096});
    table.read("seed", source.seed);
    table.read("noise_sigma", source.noise_sigma, {0, 255});
    std::filesystem::path left = source.left, right = source.right;
    table.read("left", left);
    table.read("right", right);
    source.left = left.string();
    source.right = right.string();
    table.read("side_by_side", source.side_by_side);
    if (source.side_by_side && !source.right.empty())
        table.refuse("side_by_side", "means that 'left' holds both sides: leave 'right' out");
    if (source.kind == "files" && !source.left.empty() && source.right.empty() &&
        !source.side_by_side)
        table.refuse("left",
                     "names one side only: name the other camera's pictures with 'right', or say "
                     "side_by_side = true where each picture holds the left side in its left half "
                     "and the right side in its right half");
    table.read("left_device", source.left_device);
    table.read("right_device", source.right_device);
    const bool has_cameras = source.kind == "v4l2" || source.kind == "libcamera";
    if (has_cameras && source.side_by_side && !source.right_device.empty())
        table.refuse("side_by_side",
                     "means that 'left_device' delivers both sides: leave 'right_device' out");
    if (has_cameras && !source.left_device.empty() && source.right_device.empty() &&
        !source.side_by_side)
        table.refuse("left_device",
                     "names one camera only: name the other one with 'right_device', or say "
                     "side_by_side = true if each of its pictures holds the left side in its left "
                     "half and the right side in its right half");
    table.read("first", source.first, {0});
    table.read("frames", source.frames, {0});
    table.read("loop", source.loop);
    table.read("pixel_format", source.pixel_format);
    if (!source.pixel_format.empty() && source.pixel_format.size() != 4)
        table.refuse("pixel_format", "must be a code of four characters such as 'GREY' or 'MJPG'");
    table.read_choice("buffers", source.buffers, {"auto", "import", "copy"});
    table.read("controls", source.controls);
    constexpr double largest_gain = 64;
    table.read("exposure_us", source.exposure_us, {1, 1e6});
    table.read("analogue_gain", source.analogue_gain, {1, largest_gain});
    table.read("red_gain", source.red_gain, {0, largest_gain});
    table.read("blue_gain", source.blue_gain, {0, largest_gain});
}

void read_virtual_rig(TomlTable& table, RigConfig::VirtualRig& rig) {
    table.read("azimuth_deg", rig.azimuth_deg, {-360, 360});
    table.read("elevation_deg", rig.elevation_deg, {-80, 80});
    table.read("distance_m", rig.distance_m, {0.1, 1000});
    table.read("baseline_m", rig.baseline_m, {0.001, 10});
    table.read("field_of_view_deg", rig.field_of_view_deg, {1, 150});
    table.read("doffs_px", rig.doffs_px, {-4096, 4096});
    table.rename("set", "scene");  // old name
    table.read("scene", rig.scene, {0, 1000000});
    table.read("loop_mb", rig.loop_mb, {0, 1e6});
    table.read("loop_ahead", rig.loop_ahead);
    constexpr double second_us = 1e6;
    table.read("bar_leds", rig.bar_leds, {0, 20});
    if (rig.bar_leds > 0 && rig.bar_leds < 5)
        table.refuse("bar_leds", "must be 0, for no bar, or 5 to 20");
    table.read("bar_step_us", rig.bar_step_us, {10, second_us});
    table.read("left_skew_us", rig.left_skew_us, {-second_us, second_us});
    table.read("right_skew_us", rig.right_skew_us, {-second_us, second_us});
}

void read_trigger(TomlTable& table, RigConfig::Trigger& trigger) {
    constexpr double second_us = 1e6;
    table.read_choice("role", trigger.role, {"lead", "follow", "free"});
    table.read("chip", trigger.chip);
    table.read("line", trigger.line);
    table.read("line_offset", trigger.line_offset, {0, 4096});
    table.read("active_low", trigger.active_low);
    table.read("pretended", trigger.pretended);
    table.read_choice("start", trigger.start, {"host", "at_once"});
    table.read("sensor", trigger.sensor);
    table.read("exposure_us", trigger.exposure_us, {1, second_us});
    table.read("exposure_offset_us", trigger.exposure_offset_us, {0, second_us});
    table.read("readout_us", trigger.readout_us, {0, second_us});
    table.read("timestamp_delay_us", trigger.timestamp_delay_us, {0, second_us});
    table.read("late_limit_us", trigger.late_limit_us, {1, second_us});
    table.read("spin_us", trigger.spin_us, {0, second_us / 100});
    table.read("realtime_priority", trigger.realtime_priority, {0, 99});
    if (!trigger.line.empty() && trigger.line_offset >= 0)
        table.refuse("line_offset", "cannot be combined with 'line': keep one");
    const bool has_line = !trigger.line.empty() || trigger.line_offset >= 0;
    if (trigger.role == "free" || (trigger.pretended && trigger.role == "lead")) return;
    if (trigger.pretended)
        table.refuse("pretended", "needs the role 'lead': other roles need an edge");
    if (trigger.chip.empty() || !has_line)
        table.refuse("role",
                     "needs 'chip', the label of a GPIO chip, and 'line' or 'line_offset' "
                     "(vantage-rig probe lists them)");
}

void read_match(TomlTable& table, RigConfig::Match& match) {
    table.read("matcher", match.matcher);
    table.read_choice("preset", match.preset, {"auto", "fast", "balanced", "quality"});
    table.read("width_px", match.width_px, {16, 4096});
    table.read("disparities", match.disparities, {1, 256});
    table.read("fill", match.fill);
    table.read("steady", match.steady);
}

void read_stream(TomlTable& table, RigConfig::Stream& stream) {
    table.read("bind", stream.bind);
    check_endpoint(table, "bind", stream.bind);
    table.read_choice("road", stream.road, {"tcp", "srt"});
    table.read("jpeg_quality", stream.jpeg_quality, {0, 100});
    table.read_choice("chroma", stream.chroma, {"4:4:4", "4:2:2", "4:2:0"});
    table.read("queue_frames", stream.queue_frames, {1, 64});
    table.read("key_file", stream.key_file);
    table.read("authorized_hosts", stream.authorized_hosts);
}

void read_keep(TomlTable& table, RigConfig::Keep& keep) {
    table.read("folder", keep.folder);
    table.read("hours", keep.hours, {0.01, 10000});
    table.read("gigabytes", keep.gigabytes, {0.01, 1e6});
    table.read("minutes", keep.minutes, {0.05, 60});
}

}  // namespace

RigConfig load_rig_config(const std::filesystem::path& path) {
    RigConfig config;
    config.file = path;
    config.name = computer_name();
    read_toml_file(path, rig_config_version, [&](TomlTable& top) {
        read_stream_name(top, config.name);
        std::string calibration;
        top.read("calibration", calibration);
        config.uncalibrated = calibration == "none";
        if (!config.uncalibrated) top.read("calibration", config.calibration);
        top.read_table("source", [&](TomlTable& t) { read_source(t, config.source); });
        top.read_table("virtual_rig",
                       [&](TomlTable& t) { read_virtual_rig(t, config.virtual_rig); });
        top.read_table("trigger", [&](TomlTable& t) { read_trigger(t, config.trigger); });
        top.read_table("match", [&](TomlTable& t) { read_match(t, config.match); });
        top.read_table("stream", [&](TomlTable& t) { read_stream(t, config.stream); });
        top.read_table("keep", [&](TomlTable& t) { read_keep(t, config.keep); });
    });
    return config;
}

}  // namespace vantage
