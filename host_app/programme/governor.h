#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// Chooses the best quality level whose work fits into a given time; higher levels are cheaper. It
/// falls when several works in a row did not fit, by as many levels as needed. It rises only after
/// a while with time to spare, and waits longer the sooner it had to fall again, which prevents
/// oscillation. Not thread-safe.
class LevelChooser {
  public:
    /// Work may take `share` of the time. `best_level_ratio` is the time of the best level over
    /// that of the next one, as long as neither was measured here.
    LevelChooser(std::size_t levels, double share, double best_level_ratio = untried_ratio);

    std::size_t level() const { return level_; }
    /// Starts at the cheapest level, and rises quickly until it first has to fall. To be called
    /// before the first work.
    void begin_with_the_cheapest();
    /// Fixes the level.
    void fix(std::size_t level);
    void set_share(double share) { share_ = share; }

    /// The best level, from the present one on, whose work usually takes at most `ms`; the cheapest
    /// one if none is known to. A fixed level stays.
    std::size_t fitting(double ms) const;

    /// Records that a work at `level` took `work_ms` of the available `time_ms`.
    void saw(std::size_t level, double work_ms, double time_ms, MonotonicTime now);

    /// Shares of the time that was spent at each level.
    std::vector<double> shares(MonotonicTime now) const;

  private:
    /// Time of a level that was not tried over that of the next cheaper one.
    static constexpr double untried_ratio = 1.6;

    void go_to(std::size_t level, MonotonicTime now);

    double share_, best_level_ratio_;
    std::size_t level_ = 0;
    bool is_fixed_ = false, is_risen_to_ = false;
    std::vector<std::optional<double>> usual_ms_;  ///< by level; empty: not tried yet
    int misfits_ = 0;
    std::optional<MonotonicTime> since_;  ///< start of the present level
    std::optional<MonotonicTime> fitting_since_;
    std::vector<double> spent_s_;
    double wait_s_;  ///< before the next rise
};

/// The value of `--quality`.
struct QualityRequest {
    std::optional<std::size_t> level;  ///< empty: the best level that fits
    /// Parses "best", "auto" or a number from 0 (the best). Throws Error otherwise.
    static QualityRequest parse(const std::string& text);
};

/// Keeps the programme at its frame rate and the instants at the rate of the stage. It measures how
/// long rendering and preparing take and chooses the quality level of each. Not thread-safe.
class Governor {
  public:
    /// `rate_hz` is the frame rate of the output, `pulse_rate_hz` that of the stage.
    Governor(double rate_hz, double pulse_rate_hz, const QualityRequest& request);

    const RenderLevel& render() const { return render_levels()[render_.level()]; }
    const PrepareLevel& prepare() const { return prepare_levels()[prepare_.level()]; }
    /// Level for the first frame after a jump in time, which the operator is waiting for.
    const PrepareLevel& prepare_sought() const;

    /// Records the time of a frame. With `is_reprojected` reprojections fill the ticks until the
    /// next frame, so it may take longer than a tick if pulses are rarer than ticks.
    void saw_render(const RenderLevel& level, double ms, bool is_reprojected, MonotonicTime now) {
        render_.saw(static_cast<std::size_t>(level.rank), ms,
                    is_reprojected ? reprojected_frame_ms_ : tick_ms_, now);
    }
    void saw_prepare(int rank, double ms, MonotonicTime now);
    /// Records the time to fetch and prepare an instant of the past.
    void saw_past_instant(double ms);
    /// Number of moments per pulse that are prepared in slow motion at this speed: at most as many
    /// per second as there are live pulses, and as the time allows. 1: pulses only.
    int moments_a_pulse(double speed) const;
    /// The share of the time that frames may take in all, less if instants are late beside them.
    double rendering_budget() const;
    std::vector<double> render_shares(MonotonicTime now) const { return render_.shares(now); }
    std::vector<double> prepare_shares(MonotonicTime now) const { return prepare_.shares(now); }

  private:
    double tick_ms_, instant_ms_;
    double reprojected_frame_ms_;  ///< time available for a frame that is reprojected meanwhile
    double rendering_share_;       ///< smaller if even the cheapest instants are late beside it
    LevelChooser render_, prepare_;
    std::deque<double> past_ms_;  ///< times of the last instants of the past
};

}  // namespace vantage
