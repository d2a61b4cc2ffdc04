#include "calib_tools/sync/sensor_exposures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "calib_tools/sync/bar_finder.h"
#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/base/time/time.h"
#include "common/colour/colour_correction.h"

namespace vantage {
namespace {

/// Values of at least this may be clipped.
constexpr int clipped_value = 250;
/// Largest share of an LED's light that may stay unexplained. Above it, the row is not the bar that
/// was asked for.
constexpr double most_misfit = 0.05;
/// Up to this misfit, another transfer function may explain the light.
constexpr double doubtful_misfit = 0.2;
constexpr double least_used_share = 0.6;

using CodeTable = std::array<double, 256>;

struct Transfer {
    const char* name;
    CodeTable light;  ///< linear light of every pixel value, 0 to 1
};

Transfer transfer(const char* name, double (*light_of)(double)) {
    Transfer made{name, {}};
    for (std::size_t code = 0; code < made.light.size(); ++code)
        made.light[code] = light_of(static_cast<double>(code) / 255);
    return made;
}

std::vector<Transfer> transfers() {
    return {transfer("sRGB", [](double code) { return srgb_decode(code); }),
            transfer("linear", [](double code) { return code; }),
            transfer("gamma 1.8", [](double code) { return std::pow(code, 1.8); })};
}

/// Pixels in which the light of an LED is measured.
struct LedPixels {
    std::vector<cv::Point> points;
    bool is_clipped = false;  ///< most pixels were too bright in some image
};

LedPixels pixels_of(const BlinkingSpot& spot, double apart_px,
                    const std::vector<GreyImage>& pictures) {
    const double radius = std::clamp(1.2 * spot.radius_px, 0.75, 0.45 * std::max(apart_px, 2.0));
    const cv::Rect all(cv::Point(), pictures.front().size());
    LedPixels led;
    int clipped = 0;
    for (int y = static_cast<int>(std::floor(spot.centre_px.y - radius));
         y <= spot.centre_px.y + radius; ++y)
        for (int x = static_cast<int>(std::floor(spot.centre_px.x - radius));
             x <= spot.centre_px.x + radius; ++x) {
            const cv::Point point(x, y);
            if (!all.contains(point) || cv::norm(cv::Point2d(x, y) - spot.centre_px) > radius)
                continue;
            if (std::any_of(pictures.begin(), pictures.end(), [&](const GreyImage& picture) {
                    return picture(point) >= clipped_value;
                }))
                ++clipped;
            else
                led.points.push_back(point);
        }
    led.is_clipped = clipped > static_cast<int>(led.points.size());
    return led;
}

LedLight light_of(const std::vector<LedPixels>& leds, const std::vector<int>& numbers,
                  const std::vector<GreyImage>& pictures, const CodeTable& light) {
    LedLight seen{numbers, Eigen::MatrixXd(pictures.size(), leds.size())};
    for (std::size_t i = 0; i < pictures.size(); ++i)
        for (std::size_t k = 0; k < leds.size(); ++k) {
            double sum = 0;
            for (const cv::Point& point : leds[k].points) sum += light[pictures[i](point)];
            seen.light(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
                sum / static_cast<double>(leds[k].points.size());
        }
    return seen;
}

/// Row of spots interpreted as the bar's slowest LEDs, slowest first.
struct Reading {
    SpotRow row;
    SensorExposures exposures;
    bool is_clipped = false;
};

Reading read_row(SpotRow row, const std::vector<GreyImage>& pictures, const SyncBar& bar,
                 const Transfer& code) {
    Reading reading;
    reading.exposures.transfer = code.name;
    std::vector<LedPixels> leds;
    std::vector<int> numbers;
    for (std::size_t k = 0; k < row.size(); ++k) {
        const std::size_t beside = k > 0 ? k - 1 : k + 1;
        leds.push_back(
            pixels_of(row[k], cv::norm(row[k].centre_px - row[beside].centre_px), pictures));
        numbers.push_back(bar.leds() - 1 - static_cast<int>(k));
        reading.is_clipped = reading.is_clipped || leds.back().is_clipped;
    }
    reading.exposures.leds_seen = static_cast<int>(row.size());
    reading.row = std::move(row);
    if (!reading.is_clipped &&
        std::none_of(leds.begin(), leds.end(), [](const auto& led) { return led.points.empty(); }))
        reading.exposures.fit = fit_exposures(bar, light_of(leds, numbers, pictures, code.light));
    return reading;
}

bool explains(const ExposureFit& fit, std::size_t pictures) {
    return fit.misfit < most_misfit && fit.used >= least_used_share * static_cast<double>(pictures);
}

/// True if most exposures are as far apart on the bar as their pulses are in time.
bool goes_with_pulses(const ExposureFit& fit, const BarFilm& film, const SyncBar& bar,
                      double rate_hz) {
    constexpr double tolerance = 1.0 / 16;  // share of the period; the bar may run on another clock
    const double period_ms = to_ms(bar.period());
    std::vector<double> lags_ms;
    for (std::size_t i = 0; i < film.pulses.size(); ++i)
        if (fit.exposures[i].used)
            lags_ms.push_back(fit.exposures[i].centre_ms -
                              1e3 / rate_hz *
                                  static_cast<double>(film.pulses[i] - film.pulses.front()));
    const auto agreeing = [&](double lag_ms) {
        return std::count_if(lags_ms.begin(), lags_ms.end(), [&](double other_ms) {
            return std::abs(std::remainder(other_ms - lag_ms, period_ms)) < tolerance * period_ms;
        });
    };
    return std::any_of(lags_ms.begin(), lags_ms.end(), [&](double lag_ms) {
        return static_cast<double>(agreeing(lag_ms)) >=
               least_used_share * static_cast<double>(film.pulses.size());
    });
}

/// Widest gap in an LED's wave without a used image, as a share of the wave.
double widest_gap(const ExposureFit& fit, const BarFilm& film, double wave_ms, double rate_hz) {
    std::vector<double> phases;
    for (std::size_t i = 0; i < film.pulses.size(); ++i)
        if (fit.exposures[i].used) {
            const auto pulses = static_cast<double>(film.pulses[i] - film.pulses.front());
            phases.push_back(std::fmod(1e3 / rate_hz * pulses / wave_ms, 1));
        }
    std::sort(phases.begin(), phases.end());
    double gap = phases.front() + 1 - phases.back();
    for (std::size_t i = 1; i < phases.size(); ++i) gap = std::max(gap, phases[i] - phases[i - 1]);
    return gap;
}

/// Increases the sigmas if the images cover few phases of the LEDs that give an exposure's ends:
/// the uncertainty is then half a wave of the slowest of these LEDs.
void doubt_missed_phases(SensorExposures& seen, const BarFilm& film, const SyncBar& bar,
                         double rate_hz) {
    constexpr double most_gap = 0.24;  // four phases are too few
    int missed = 0;
    while (missed < bar.leds() &&
           widest_gap(seen.fit, film, 2 * to_ms(bar.half_wave(missed)), rate_hz) > most_gap)
        ++missed;
    if (missed == 0 || to_ms(bar.half_wave(missed - 1)) < seen.fit.length_ms) return;
    seen.misses_phases = true;
    for (Exposure& exposure : seen.fit.exposures) {
        exposure.is_resolved = false;
        exposure.sigma_ms = std::max(exposure.sigma_ms, to_ms(bar.half_wave(missed - 1)));
    }
}

/// Either end of the row may be the slow one, and a spot beyond the end may not be an LED.
std::vector<SpotRow> ways_to_read(const SpotRow& row, const SyncBar& bar) {
    constexpr std::size_t most_strangers = 1;
    std::vector<SpotRow> ways;
    for (std::size_t strangers = 0; strangers <= most_strangers; ++strangers)
        for (const bool is_reversed : {false, true}) {
            if (row.size() < SyncBar::least_leds + strangers) continue;
            SpotRow way = row;
            if (is_reversed) std::reverse(way.begin(), way.end());
            way.erase(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(strangers));
            way.resize(std::min(way.size(), static_cast<std::size_t>(bar.leds())));
            ways.push_back(std::move(way));
        }
    return ways;
}

/// Extends the row by the faster LEDs that blink too little to be detected or were covered, at the
/// positions where the row continues.
SpotRow extended(SpotRow row, const SyncBar& bar) {
    constexpr std::size_t over = 3;
    const cv::Point2d step =
        (row.back().centre_px - row[row.size() - 1 - over].centre_px) / static_cast<double>(over);
    while (row.size() < static_cast<std::size_t>(bar.leds()))
        row.push_back({row.back().centre_px + step, row.back().radius_px});
    return row;
}

/// Reason why nothing can be read.
struct Hindrance {
    bool is_clipped = false;
    bool counts_otherwise = false;  ///< a row looks like the bar but does not follow the pulses
};

/// Reads the longest possible row: parts of it, such as every second LED, may fit some exposures by
/// chance.
std::optional<Reading> read_longest(const std::vector<SpotRow>& rows, const BarFilm& film,
                                    const SyncBar& bar, double rate_hz, Hindrance& hindrance) {
    const std::vector<Transfer> codes = transfers();
    for (const SpotRow& row : rows)
        for (SpotRow& way : ways_to_read(row, bar)) {
            Reading best = read_row(std::move(way), film.pictures, bar, codes.front());
            hindrance.is_clipped = hindrance.is_clipped || best.is_clipped;
            if (best.exposures.fit.misfit > doubtful_misfit) continue;
            const Transfer* code_of_best = codes.data();
            for (const Transfer& code : std::span(codes).subspan(1)) {
                Reading reading = read_row(best.row, film.pictures, bar, code);
                if (reading.exposures.fit.misfit >= best.exposures.fit.misfit) continue;
                best = std::move(reading);
                code_of_best = &code;
            }
            if (!explains(best.exposures.fit, film.pictures.size())) continue;
            Reading whole = read_row(extended(best.row, bar), film.pictures, bar, *code_of_best);
            if (explains(whole.exposures.fit, film.pictures.size())) best = std::move(whole);
            if (goes_with_pulses(best.exposures.fit, film, bar, rate_hz)) return best;
            hindrance.counts_otherwise = true;
        }
    return std::nullopt;
}

}  // namespace

GreyImage brightest_channel(const ColourImage& picture) {
    GreyImage grey(picture.size());
    std::transform(picture.begin(), picture.end(), grey.begin(), [](const cv::Vec4b& pixel) {
        return std::max({pixel[0], pixel[1], pixel[2]});
    });
    return grey;
}

SensorExposures read_bar(const BarFilm& film, const SyncBar& bar, double rate_hz) {
    const std::string& sensor = film.sensor;
    const std::size_t count = film.pictures.size();
    if (count < fewest_pictures)
        fail("{}: {} are too few, {} are needed and 20 are good", sensor, counted(count, "picture"),
             fewest_pictures);
    for (const GreyImage& picture : film.pictures)
        if (picture.size() != film.pictures.front().size())
            fail("{}: its pictures are {}x{} and {}x{}; give those of one film", sensor,
                 film.pictures.front().cols, film.pictures.front().rows, picture.cols,
                 picture.rows);
    int spots = 0;
    Hindrance hindrance;
    std::optional<Reading> read =
        read_longest(find_spot_rows(film.pictures, spots), film, bar, rate_hz, hindrance);
    if (read) {
        doubt_missed_phases(read->exposures, film, bar, rate_hz);
        return read->exposures;
    }
    if (hindrance.is_clipped)
        fail(
            "{}: the bar's LEDs are clipped (values from {} up), and how long they were lit cannot "
            "be told: dim them, close the iris or expose shorter",
            sensor, clipped_value);
    if (hindrance.counts_otherwise)
        fail(
            "{}: a bar is seen that does not count {} LEDs in steps of {:g} ms: name its own "
            "(--leds, --step-us); or its slowest LEDs did not change in {} pictures: film more",
            sensor, bar.leds(), to_ms(bar.step()), count);
    fail(
        "{}: no bar of {} LEDs that counts steps of {:g} ms is seen in {} pictures ({}): bring all "
        "of it into view, sharp, at least 4 px from LED to LED, let nothing pass before it, and "
        "name its LEDs and step (--leds, --step-us); an exposure near the bar's period of {:.4g} "
        "ms or longer shows none either: expose shorter, or count slower",
        sensor, bar.leds(), to_ms(bar.step()), count,
        spots == 1 ? std::string("1 spot blinks") : fmt::format("{} spots blink", spots),
        to_ms(bar.period()));
}

}  // namespace vantage
