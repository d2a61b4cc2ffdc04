#include "calib_tools/sync/stage_sync.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/base/time/time.h"
#include "common/board/median.h"

namespace vantage {
namespace {

/// Difference of two sensors' exposures at one pulse.
struct Difference {
    double skew_ms = 0, sigma_ms = 0;
    bool is_resolved = false;
};

std::vector<Difference> differences(const SensorFilm& film, const SensorFilm& reference,
                                    double period_ms) {
    std::map<std::uint64_t, const Exposure*> known;
    for (std::size_t i = 0; i < reference.pulses.size(); ++i)
        if (reference.seen.fit.exposures[i].used)
            known[reference.pulses[i]] = &reference.seen.fit.exposures[i];
    std::vector<Difference> all;
    for (std::size_t i = 0; i < film.pulses.size(); ++i) {
        const Exposure& here = film.seen.fit.exposures[i];
        const auto there = known.find(film.pulses[i]);
        if (!here.used || there == known.end()) continue;
        all.push_back(
            {.skew_ms = std::remainder(here.centre_ms - there->second->centre_ms, period_ms),
             .sigma_ms = std::hypot(here.sigma_ms, there->second->sigma_ms),
             .is_resolved = here.is_resolved && there->second->is_resolved});
    }
    return all;
}

/// Circular median over the bar's period, around the difference that is nearest to all others.
double median_on_ring(const std::vector<Difference>& all, double period_ms) {
    double best_ms = 0, least = INFINITY;
    for (const Difference& candidate : all) {
        double sum = 0;
        for (const Difference& other : all)
            sum += std::abs(std::remainder(other.skew_ms - candidate.skew_ms, period_ms));
        if (sum >= least) continue;
        least = sum;
        best_ms = candidate.skew_ms;
    }
    return best_ms;
}

void combine(const std::vector<Difference>& all, double period_ms, double pulse_ms,
             SensorSkew& sensor) {
    const double usual_ms = median_on_ring(all, period_ms);
    std::vector<Difference> near;
    std::vector<double> ways_ms;
    for (const Difference& each : all) {
        const double way_ms = std::remainder(each.skew_ms - usual_ms, period_ms);
        if (std::abs(way_ms) >= pulse_ms / 4) {
            ++sensor.strays;
            continue;
        }
        near.push_back({usual_ms + way_ms, each.sigma_ms, each.is_resolved});
        ways_ms.push_back(std::abs(way_ms));
    }
    // Exposures without an LED change are known only to lie between two changes, whatever their
    // number; they count only if there is nothing better.
    const auto resolved = std::partition(near.begin(), near.end(),
                                         [](const Difference& each) { return each.is_resolved; });
    const bool is_resolved = resolved - near.begin() >= fewest_pictures / 2;
    if (is_resolved) near.erase(resolved, near.end());
    constexpr double outlier_times = 6;
    const double limit_ms = outlier_times * (median(ways_ms) + near.front().sigma_ms);
    double weights = 0, sum = 0, squares = 0, least_sigma_ms = INFINITY;
    int count = 0;
    for (const Difference& each : near) {
        if (std::abs(each.skew_ms - usual_ms) > limit_ms) continue;
        const double weight = 1 / (each.sigma_ms * each.sigma_ms);
        weights += weight;
        sum += weight * each.skew_ms;
        least_sigma_ms = std::min(least_sigma_ms, each.sigma_ms);
        ++count;
    }
    const double skew_ms = sum / weights;
    for (const Difference& each : near)
        if (std::abs(each.skew_ms - usual_ms) <= limit_ms)
            squares += (each.skew_ms - skew_ms) * (each.skew_ms - skew_ms);
    const double scatter_ms = count > 1 ? std::sqrt(squares / (count - 1) / count) : least_sigma_ms;
    sensor.skew_ms = std::remainder(skew_ms, period_ms);
    sensor.sigma_ms = is_resolved ? std::max(std::sqrt(1 / weights), scatter_ms) : least_sigma_ms;
    sensor.pictures = count;
    const double pulses = std::round(sensor.skew_ms / pulse_ms);
    if (std::abs(sensor.skew_ms - pulses * pulse_ms) <= pulse_ms / 4)
        sensor.pulses_apart = static_cast<int>(pulses);
}

std::string apart_words(int pulses, double skew_ms) {
    return fmt::format("{} {} ({:+.2f} ms)",
                       counted(static_cast<std::size_t>(std::abs(pulses)), "frame"),
                       pulses > 0 ? "behind" : "ahead of", skew_ms);
}

/// The two sensors of a rig, if both exist.
struct RigPair {
    const SensorSkew *left = nullptr, *right = nullptr;
};
std::vector<RigPair> pairs_of(const SyncRecord& record) {
    std::map<std::string, RigPair> by_name;
    for (const SensorSkew& s : record.sensors)
        (s.is_left ? by_name[s.rig].left : by_name[s.rig].right) = &s;
    std::vector<RigPair> pairs;
    for (const auto& [name, pair] : by_name)
        if (pair.left && pair.right) pairs.push_back(pair);
    return pairs;
}

}  // namespace

std::vector<SensorSkew> skews_of(const std::vector<SensorFilm>& films, const SyncBar& bar,
                                 double rate_hz) {
    std::vector<SensorSkew> skews;
    const SensorFilm& reference = films.front();
    for (const SensorFilm& film : films) {
        SensorSkew sensor;
        sensor.rig = film.rig;
        sensor.is_left = film.is_left;
        sensor.exposure_ms = film.seen.fit.length_ms;
        const std::vector<Difference> all = differences(film, reference, to_ms(bar.period()));
        if (all.size() < fewest_pictures)
            fail(
                "{}: only {} of its pictures are of pulses of which {} {} has a picture too, and "
                "{} are needed: film all rigs at the same time",
                sensor.name(), all.size(), reference.rig, reference.is_left ? "left" : "right",
                fewest_pictures);
        if (&film == &reference)
            sensor.pictures = static_cast<int>(all.size());
        else
            combine(all, to_ms(bar.period()), 1e3 / rate_hz, sensor);
        skews.push_back(std::move(sensor));
    }
    return skews;
}

std::vector<std::string> sync_troubles(const SyncRecord& record, double limit_ms) {
    std::vector<std::string> troubles;
    for (const RigPair& pair : pairs_of(record)) {
        const int apart = pair.right->pulses_apart - pair.left->pulses_apart;
        const double skew_ms = pair.right->skew_ms - pair.left->skew_ms;
        if (apart != 0)
            troubles.push_back(fmt::format(
                "{} is {} {}: the pair is not of one pulse; look for lost pulses, and start the "
                "rig again",
                pair.right->name(), apart_words(apart, skew_ms), pair.left->name()));
        else if (std::abs(skew_ms) > limit_ms)
            troubles.push_back(fmt::format(
                "{} exposes {:.2f} ms {} than {}: one of them is not on the pulse line, or exposes "
                "{:.2f} and the other {:.2f} ms",
                pair.right->name(), std::abs(skew_ms), skew_ms > 0 ? "later" : "earlier",
                pair.left->name(), pair.right->exposure_ms, pair.left->exposure_ms));
    }
    for (const SensorSkew& s : record.sensors) {
        if (s.strays > 0)
            troubles.push_back(
                fmt::format("{} was elsewhere in {} of {}: it loses pulses or counts them wrongly",
                            s.name(), s.strays, counted(s.pictures + s.strays, "picture")));
        if (!s.is_left || s.name() == record.reference) continue;
        if (s.pulses_apart != 0)
            troubles.push_back(fmt::format(
                "{} is {} {}: rig {} counts pulses differently; compare its clock "
                "(vantage rigs status) and its timestamp_delay_us",
                s.name(), apart_words(s.pulses_apart, s.skew_ms), record.reference, s.rig));
        else if (std::abs(s.skew_ms) > limit_ms)
            troubles.push_back(fmt::format(
                "{} exposes {:.2f} ms {} than {}: look at PTP and at the lateness of pulses "
                "(vantage rigs status)",
                s.name(), std::abs(s.skew_ms), s.skew_ms > 0 ? "later" : "earlier",
                record.reference));
    }
    return troubles;
}

std::vector<std::string> sync_doubts(const SyncRecord& record, double limit_ms) {
    std::vector<std::string> doubts;
    for (const SensorSkew& s : record.sensors)
        if (2 * s.sigma_ms > limit_ms)
            doubts.push_back(fmt::format(
                "{} is known to {:.2f} ms only, and the limit is {:g} ms: film more pictures, or a "
                "bar that counts faster",
                s.name(), 2 * s.sigma_ms, limit_ms));
    return doubts;
}

std::string describe(const SyncRecord& record) {
    std::size_t width = 6;
    for (const SensorSkew& s : record.sensors) width = std::max(width, s.name().size());
    std::string text = fmt::format("{:<{}}  {:>9}  {:>7}  {:>11}  {:>8}\n", "sensor", width,
                                   "skew ms", "+- ms", "exposure ms", "pictures");
    for (const SensorSkew& s : record.sensors)
        text += s.name() == record.reference
                    ? fmt::format("{:<{}}  {:>9}  {:>7}  {:>11.3f}  {:>8}\n", s.name(), width,
                                  "reference", "", s.exposure_ms, s.pictures)
                    : fmt::format("{:<{}}  {:>+9.3f}  {:>7.3f}  {:>11.3f}  {:>8}\n", s.name(),
                                  width, s.skew_ms, s.sigma_ms, s.exposure_ms, s.pictures);
    for (const RigPair& pair : pairs_of(record))
        text += fmt::format("{}: right {:+.3f} ms after left\n", pair.left->rig,
                            pair.right->skew_ms - pair.left->skew_ms);
    return text + fmt::format("furthest apart: {:.3f} ms\n", record.worst_ms());
}

nlohmann::ordered_json to_json(const SyncRecord& record) {
    nlohmann::ordered_json sensors = nlohmann::ordered_json::array();
    for (const SensorSkew& s : record.sensors)
        sensors.push_back({{"rig", s.rig},
                           {"side", s.is_left ? "left" : "right"},
                           {"skew_ms", s.skew_ms},
                           {"sigma_ms", s.sigma_ms},
                           {"exposure_ms", s.exposure_ms},
                           {"pictures", s.pictures},
                           {"strays", s.strays},
                           {"pulses_apart", s.pulses_apart}});
    nlohmann::ordered_json rigs = nlohmann::ordered_json::array();
    for (const RigPair& pair : pairs_of(record))
        rigs.push_back({{"name", pair.left->rig},
                        {"right_after_left_ms", pair.right->skew_ms - pair.left->skew_ms}});
    return {{"date", record.date},          {"reference", record.reference},
            {"rate_hz", record.rate_hz},    {"bar_step_ms", record.bar_step_ms},
            {"sensors", sensors},           {"rigs", rigs},
            {"worst_ms", record.worst_ms()}};
}

}  // namespace vantage
