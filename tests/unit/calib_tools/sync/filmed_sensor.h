#pragma once

#include <chrono>
#include <vector>

#include "calib_tools/sync/stage_sync.h"
#include "common/base/time/pulse_grid.h"
#include "common/virtual_stage/filmed_bar.h"
#include "common/virtual_stage/virtual_rig.h"

namespace vantage {

using std::chrono::microseconds;

/// A sensor that films the bar and a moving stripe behind it at every few pulses of the stage.
struct FilmedSensor {
    std::chrono::nanoseconds skew{}, exposure = microseconds(5000);
    double noise_sigma = 2;
    std::uint64_t seed = 1;
    cv::Size size{320, 240};
    BarPlace place = BarPlace::across({320, 240}, 12);
    int count = 24;
    double rate_hz = 30;
    bool has_bar = true;

    std::vector<std::uint64_t> pulses() const {
        std::vector<std::uint64_t> all;
        for (int i = 0; i < count; ++i)
            all.push_back(first_pulse + 6 * static_cast<std::uint64_t>(i));
        return all;
    }

    GreyImage picture(const SyncBar& bar, std::uint64_t pulse,
                      std::chrono::nanoseconds more = {}) const {
        ColourImage seen(size, cv::Vec4b(70, 80, 90, 255));
        // Somebody walks through below the bar.
        const int x = static_cast<int>(pulse * 7 % static_cast<std::uint64_t>(size.width - 40));
        seen(cv::Rect(x, size.height / 3, 30, size.height / 2)) = cv::Vec4b(190, 160, 140, 255);
        if (has_bar)
            FilmedBar(bar, place, exposure)
                .draw(seen, PulseGrid(rate_hz).time_of(pulse) + skew + more);
        add_sensor_noise(seen, {noise_sigma, seed}, 0, pulse);
        return brightest_channel(seen);
    }

    BarFilm film_of(const SyncBar& bar) const {
        BarFilm film{"A left", {}, pulses()};
        for (const std::uint64_t pulse : film.pulses) film.pictures.push_back(picture(bar, pulse));
        return film;
    }

    /// Read, as rig `name`'s left or right one.
    SensorFilm film(const SyncBar& bar, const std::string& name, bool is_left) const {
        return {name, is_left, pulses(), read_bar(film_of(bar), bar, rate_hz)};
    }

    /// In November 2026.
    static constexpr std::uint64_t first_pulse = 53'850'000'000;
};

}  // namespace vantage
