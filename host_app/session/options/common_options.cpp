#include "host_app/session/options/common_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <vector>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/timecode.h"
#include "common/gl/context/limits.h"

namespace vantage {
namespace {

/// Limit of a quilt: the largest displays have about 100 views.
constexpr int max_quilt_views = 128;

cv::Size parse_quilt(const std::string& text) {
    int columns = 0, rows = 0, used = 0;
    if (std::sscanf(text.c_str(), "%3dx%3d%n", &columns, &rows, &used) != 2 ||
        static_cast<std::size_t>(used) != text.size() || columns < 1 || rows < 1 ||
        columns * rows < 2 || columns * rows > max_quilt_views)
        fail("--quilt '{}' is not valid: give COLUMNSxROWS with 2 to {} views, such as 8x6", text,
             max_quilt_views);
    return {columns, rows};
}

}  // namespace

cv::Size parse_size(const std::string& text) {
    int width = 0, height = 0, used = 0;
    if (std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) != 2 ||
        static_cast<std::size_t>(used) != text.size() || width < 16 || height < 16 ||
        width > PiLimits::max_image_side_px || height > PiLimits::max_image_side_px)
        fail(
            "--size '{}' is not valid: give WIDTHxHEIGHT with 16 to {} pixels each, such as "
            "1280x720",
            text, PiLimits::max_image_side_px);
    return {width, height};
}

double parse_rate(const std::string& text) {
    constexpr double min_hz = 0.1, max_hz = 240;
    double pictures = 0, seconds = 1;
    const char* last = text.data() + text.size();
    std::from_chars_result read = std::from_chars(text.data(), last, pictures);
    if (read.ec == std::errc() && read.ptr != last && *read.ptr == '/')
        read = std::from_chars(read.ptr + 1, last, seconds);
    const double rate_hz = pictures / seconds;
    if (read.ec != std::errc() || read.ptr != last || !(rate_hz >= min_hz && rate_hz <= max_hz))
        fail(
            "--rate '{}' is not valid: give {:g} to {:g} frames per second, such as 50, 29.97 or "
            "30000/1001",
            text, min_hz, max_hz);
    return rate_hz;
}

CLI::Option* StereoscopicOptions::add_to(CLI::App& command, const std::string& default_convergence,
                                         const std::string& group) {
    std::vector<std::string> layouts{"off"};
    for (const std::string& name : stereo_layout_names()) layouts.push_back(name);
    CLI::Option* chosen =
        command
            .add_option("--stereoscopic", layout,
                        "Render a picture for a 3-D display: both eyes at half the width, half the "
                        "height or every other row, an anaglyph for red and cyan glasses, or a "
                        "quilt of many views")
            ->check(CLI::IsMember(layouts))
            ->group(group);
    command
        .add_option("--interaxial-m", eyes.interaxial_m,
                    "Set the distance between the outermost eyes (default: 2 % of the picture's "
                    "width of parallax at infinity, 8 % in a quilt)")
        ->check(CLI::Range(0.0001, 10.0))
        ->needs(chosen)
        ->group(group);
    command
        .add_option("--convergence-m", eyes.convergence_m,
                    "Set the distance of objects that appear at the screen (default: " +
                        default_convergence + ")")
        ->check(CLI::Range(0.01, 10000.0))
        ->needs(chosen)
        ->group(group);
    command
        .add_option("--quilt", quilt,
                    "With --stereoscopic quilt: render COLUMNSxROWS views for an autostereoscopic "
                    "display, the leftmost at the lower left (default: 8x6)")
        ->needs(chosen)
        ->group(group);
    return chosen;
}

void accept_old_name(CLI::App& command, CLI::Option* option, const std::string& old_name) {
    const auto warn = [option, old_name] {
        log_warning("{} is the old name of {} and goes with the next release", old_name,
                    option->get_name());
    };
    const bool is_flag = option->get_items_expected_max() == 0;
    CLI::Option* old = is_flag ? command.add_flag_function(old_name,
                                                           [option, warn](std::int64_t) {
                                                               warn();
                                                               option->add_result("true");
                                                               option->run_callback();
                                                           })
                               : command.add_option_function<std::string>(
                                     old_name, [option, warn](const std::string& text) {
                                         warn();
                                         option->add_result(text);
                                         option->run_callback();
                                     });
    old->group("");
}

std::optional<Stereoscopy> StereoscopicOptions::stereoscopy() const {
    if (!quilt.empty() && layout != "quilt")
        fail("--quilt does not apply to --stereoscopic {}; use --stereoscopic quilt", layout);
    if (layout == "off") return std::nullopt;
    const auto names = stereo_layout_names();
    Stereoscopy chosen = eyes;
    chosen.layout =
        static_cast<StereoLayout>(std::find(names.begin(), names.end(), layout) - names.begin());
    if (!quilt.empty()) chosen.quilt = parse_quilt(quilt);
    return chosen;
}

std::uint64_t pulse_of(const TakeReader& take, const std::string& text, std::uint64_t first,
                       std::uint64_t last) {
    const PulseGrid pulses(take.facts().pulse_rate_hz);
    if (text.find_first_of(":;") == std::string::npos) {
        std::size_t used = 0;
        double seconds = -1;
        try {
            seconds = std::stod(text, &used);
        } catch (const std::exception&) {
        }
        constexpr double max_s = 1e7;
        if (used != text.size() || !(seconds >= 0 && seconds <= max_s))
            fail(
                "'{}' is not a time: give seconds after the beginning, such as 12.5, or a time "
                "code, such as {}",
                text, take.facts().timecode);
        return first + static_cast<std::uint64_t>(std::llround(seconds * pulses.rate_hz()));
    }
    const TimecodeClock clock(take.facts().pulse_rate_hz);
    const std::optional<TimeLabel> label = TimeLabel::parse(text);
    if (!label)
        fail(
            "'{}' is not a time code such as {} (';' or ':' before the frame number, which may be "
            "left out)",
            text, take.facts().timecode);
    if (const std::string why = clock.why_never(*label); !why.empty()) fail("{} {}", text, why);
    // A search through more pulses would take minutes.
    constexpr std::uint64_t max_pulses = 1'000'000'000;
    if (last - first > max_pulses)
        fail(
            "{} has {} pulses, too many to search for time code {} (limit: {}); give seconds "
            "after its beginning",
            take.path().string(), last - first, text, max_pulses);
    const int tai_offset_s = take.facts().tai_offset_s;
    if (const auto pulse = clock.find(*label, first, last + 1, tai_offset_s)) return *pulse;
    fail("time code {} is not in {}, which goes from {} to {}", text, take.path().string(),
         clock.of_pulse(first, tai_offset_s), clock.of_pulse(last, tai_offset_s));
}

}  // namespace vantage
