#include "rig_firmware/trigger/sensor_timing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"

namespace vantage {
namespace {

struct Model {
    std::string_view name;
    double exposure_offset_us, readout_us;
};

/// Offset in microseconds and readout in microseconds of each model. The XTR input of an imx296
/// exposes for the low width plus 14.26 us; 1118 lines of 14.81 us are read out.
constexpr std::array<Model, 2> models = {{{"other", 0, 0}, {"imx296", 14.26, 16'560}}};

/// Shortest pulse that a userspace GPIO line delivers reliably to a sensor.
constexpr std::chrono::microseconds shortest_pulse{10};

Model find_model(const std::string& name) {
    const auto found =
        std::find_if(models.begin(), models.end(), [&](const Model& m) { return m.name == name; });
    if (found != models.end()) return *found;
    std::vector<std::string> known;
    known.reserve(models.size());
    for (const Model& model : models) known.emplace_back(model.name);
    fail("there is no sensor model '{}' for [trigger]; {}", name, suggest_name(name, known));
}

}  // namespace

SensorTiming sensor_timing(const RigConfig::Trigger& trigger, double rate_hz) {
    const Model model = find_model(trigger.sensor);
    const auto given_or = [](double given_us, double otherwise_us) {
        return from_us(given_us >= 0 ? given_us : otherwise_us);
    };
    SensorTiming timing;
    timing.exposure = from_us(trigger.exposure_us);
    timing.exposure_offset = given_or(trigger.exposure_offset_us, model.exposure_offset_us);
    timing.readout = given_or(trigger.readout_us, model.readout_us);
    timing.timestamp_delay = given_or(trigger.timestamp_delay_us, trigger.exposure_us);
    if (timing.pulse_width() < shortest_pulse)
        fail(
            "an exposure of {:.2f} us needs a pulse of {:.2f} us, and the shortest is {} us: "
            "raise 'exposure_us' in [trigger]",
            to_us(timing.exposure), to_us(timing.pulse_width()), shortest_pulse.count());
    const PulseGrid grid(rate_hz);
    const std::chrono::nanoseconds busy = timing.exposure + timing.readout;
    if (busy > grid.period())
        fail(
            "{:.2f} us of exposure and {:.2f} us of readout are {:.2f} us, and a period at {:.4g} "
            "Hz is {:.2f} us: lower 'rate_hz' to {:.2f} or 'exposure_us' to {:.0f}",
            to_us(timing.exposure), to_us(timing.readout), to_us(busy), grid.rate_hz(),
            to_us(grid.period()), std::floor(1e8 / to_us(busy)) / 100,
            std::max(0.0, std::floor(to_us(grid.period() - timing.readout))));
    return timing;
}

}  // namespace vantage
