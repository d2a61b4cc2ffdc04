#include "rig_firmware/clock/clock_model.h"

#include <cmath>

namespace vantage {
namespace {

constexpr std::size_t window_pairs = 64;
/// Beyond this a pair is off the line: wider than any honest reading is late...
constexpr double step_limit_ns = 500e3;
/// ...and than any crystal drifts.
constexpr double largest_rate_error = 1e-3;

double ns(std::chrono::nanoseconds duration) { return static_cast<double>(duration.count()); }

}  // namespace

void ClockModel::observe(MonotonicTime source, TaiTime tai) {
    const Pair pair{source, tai};
    if (window_.empty()) return take(pair);
    if (source <= window_.back().source || (odd_ && source <= odd_->source)) return;
    const double deviation_ns = ns(tai - to_tai(source));
    const double gap_ns = ns(source - window_.back().source);
    // Until the line has a slope it may be anything that a crystal can do.
    const double unknown_rate = window_.size() < 3 ? largest_rate_error : largest_rate_error / 50;
    if (std::abs(deviation_ns) <= step_limit_ns + unknown_rate * gap_ns) {
        if (odd_) ++outliers_;
        odd_.reset();
        return take(pair);
    }
    if (!odd_) {
        odd_ = pair;
        return;
    }
    const double apart_ns = ns((tai - odd_->tai) - (source - odd_->source));
    if (std::abs(apart_ns) <= step_limit_ns + largest_rate_error * ns(source - odd_->source)) {
        ++steps_;
        last_step_ns_ = deviation_ns;
        window_.clear();
        take(*odd_);
        odd_.reset();
        return take(pair);
    }
    ++outliers_;
    odd_ = pair;
}

void ClockModel::restart(MonotonicTime source, TaiTime tai) {
    if (ready()) {
        ++steps_;
        last_step_ns_ = ns(tai - to_tai(source));
    }
    window_.clear();
    odd_.reset();
    take({source, tai});
}

void ClockModel::take(const Pair& pair) {
    window_.push_back(pair);
    if (window_.size() > window_pairs) window_.pop_front();
    ++pairs_;
    fit();
}

void ClockModel::fit() {
    // Relative to the newest pair, in which double holds nanoseconds exactly.
    const Pair& newest = window_.back();
    double mean_x = 0, mean_y = 0;
    const auto x = [&](const Pair& p) { return ns(p.source - newest.source); };
    const auto y = [&](const Pair& p) {
        return ns((p.tai - newest.tai) - (p.source - newest.source));
    };
    for (const Pair& p : window_) {
        mean_x += x(p);
        mean_y += y(p);
    }
    const auto n = static_cast<double>(window_.size());
    mean_x /= n;
    mean_y /= n;
    double xx = 0, xy = 0;
    for (const Pair& p : window_) {
        xx += (x(p) - mean_x) * (x(p) - mean_x);
        xy += (x(p) - mean_x) * (y(p) - mean_y);
    }
    slope_ = xx > 0 ? xy / xx : 0;
    intercept_ns_ = mean_y - slope_ * mean_x;
    double squares = 0;
    for (const Pair& p : window_) {
        const double residual = y(p) - intercept_ns_ - slope_ * x(p);
        squares += residual * residual;
    }
    residual_ns_ = std::sqrt(squares / n);
}

TaiTime ClockModel::to_tai(MonotonicTime source) const {
    const Pair& newest = window_.back();
    const std::chrono::nanoseconds since = source - newest.source;
    return newest.tai + since +
           std::chrono::nanoseconds(std::llround(intercept_ns_ + slope_ * ns(since)));
}

ClockModel::State ClockModel::state() const {
    return {.ppm = -slope_ * 1e6,
            .residual_ns = residual_ns_,
            .pairs = pairs_,
            .outliers = outliers_,
            .steps = steps_,
            .last_step_ns = last_step_ns_};
}

}  // namespace vantage
