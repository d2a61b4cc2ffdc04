#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// Finds, among levels that get cheaper by rank, the best one whose work fits into a time. Falls as
/// soon as several works in a row did not fit, by as many levels as it takes; rises only after a
/// while of room, and the more cautiously the sooner it had to fall again, so that nothing pumps.
class LevelChooser {
  public:
    /// Works may take `share` of the time.
    LevelChooser(std::size_t levels, double share);

    std::size_t level() const { return level_; }
    /// Before the first work: begins there, and is quick to rise until it first had to fall.
    void begin_with_the_cheapest();
    /// From now on this one, whatever it takes.
    void fix(std::size_t level);
    /// From now on works may take so much of the time.
    void set_share(double share) { share_ = share; }

    /// The best level, of this one and those that are cheaper, whose works take so long at most by
    /// what they took before; the cheapest where none is known to. A fixed one stays.
    std::size_t fitting(double ms) const;

    /// A work at `level` took `work_ms` of the `time_ms` that there were for it.
    void saw(std::size_t level, double work_ms, double time_ms, MonotonicTime now);

    /// Shares of the time that the levels were taken for until now.
    std::vector<double> shares(MonotonicTime now) const;

  private:
    void go_to(std::size_t level, MonotonicTime now);

    double share_;
    std::size_t level_ = 0;
    bool is_fixed_ = false, is_risen_to_ = false;
    std::vector<std::optional<double>> usual_ms_;  ///< of every level that was tried
    int misfits_ = 0;
    std::optional<MonotonicTime> since_;  ///< of this level
    std::optional<MonotonicTime> fitting_since_;
    std::vector<double> spent_s_;
    double patience_s_;
};

/// What `--quality` asks for.
struct QualityRequest {
    std::optional<std::size_t> level;  ///< nothing: what fits
    /// "best", "auto" or a number from 0 (the best) on. Throws Error with the mend otherwise.
    static QualityRequest parse(const std::string& text);
};

/// Holds the programme's ticks and the stage's instants: measures what rendering and preparing
/// take, and lowers or raises either's level of quality.
class Governor {
  public:
    /// `rate_hz` of the output; `pulse_rate_hz` of the stage.
    Governor(double rate_hz, double pulse_rate_hz, const QualityRequest& request);

    const RenderLevel& render() const { return render_levels()[render_.level()]; }
    const PrepareLevel& prepare() const { return prepare_levels()[prepare_.level()]; }
    /// For the first picture of where time jumped to, which is waited for.
    const PrepareLevel& prepare_sought() const;

    /// `is_carried_on`: reprojections of the picture go between it and the next one, so that it may
    /// take longer than a tick where pulses are rarer than ticks.
    void saw_render(const RenderLevel& level, double ms, bool is_carried_on, MonotonicTime now) {
        render_.saw(static_cast<std::size_t>(level.rank), ms,
                    is_carried_on ? carried_picture_ms_ : tick_ms_, now);
    }
    void saw_prepare(int rank, double ms, MonotonicTime now);
    /// An instant of the past was fetched and prepared in so long.
    void saw_past_instant(double ms);
    /// How many moments of a pulse are prepared when the past is played at this speed: no more a
    /// second than pulses come live, and no more than there is time for. 1: pulses only.
    int moments_a_pulse(double speed) const;
    std::vector<double> render_shares(MonotonicTime now) const { return render_.shares(now); }
    std::vector<double> prepare_shares(MonotonicTime now) const { return prepare_.shares(now); }

  private:
    double tick_ms_, instant_ms_;
    double carried_picture_ms_;  ///< that one may take which is reprojected meanwhile
    double rendering_share_;     ///< less where even the cheapest instants come late beside it
    LevelChooser render_, prepare_;
    std::deque<double> past_ms_;  ///< of the last instants of the past
};

}  // namespace vantage
