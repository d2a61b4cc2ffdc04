#include "host_app/programme/governor.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/base/error.h"

namespace vantage {
namespace {

/// Number of works in a row that do not fit before the level falls. A work that takes more than
/// `far_off` times its share counts twice.
constexpr int max_misfits = 3;
constexpr double far_off = 2;
/// The level rises if the next better one is expected to take less than this share of its time.
constexpr double room = 0.75;
/// Wait before the level rises: before the first fall, after it, and at most.
constexpr double min_wait_s = 0.5, first_wait_s = 2, max_wait_s = 60;
/// Rising was a mistake if the level has to fall within this time.
constexpr double mistake_s = 5;
/// Weight of a new sample in the usual time of a level.
constexpr double mean_share = 0.2;
/// Shares of a tick for rendering and of the time between two pulses for preparing. Rendering has
/// priority over preparing and so delays instants. The time of preparing includes these delays.
constexpr double full_rendering_share = 0.65, preparing_share = 0.7;
/// Time to prepare an instant at the best level over that at the next one, on a software renderer:
/// it fuses the rigs' surfaces in every instant, and all others draw the baked background.
constexpr double best_preparing_ratio = 4;
/// Share of the time between two pulses for the moments that are prepared in slow motion.
constexpr double moments_share = 0.9;
/// Frames may take this much more of the time than the share by which their level is chosen.
constexpr double budget_margin = 0.1;
/// If the cheapest instants do not fit, the share of rendering is reduced by a factor at every
/// instant, down to a minimum; if they fit with room, it is raised again.
constexpr double min_rendering_share = 0.3, reduction = 0.93, recovery_factor = 1.03;
/// Upper limit for a frame that is reprojected meanwhile, besides half of the time between pulses.
constexpr double max_frame_ms = 64;
/// Time to prepare the instant after a jump in time, which shall take 200 ms in all.
constexpr double sought_ms = 80;

double seconds(MonotonicTime from, MonotonicTime to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

LevelChooser::LevelChooser(std::size_t levels, double share, double best_level_ratio)
    : share_(share),
      best_level_ratio_(best_level_ratio),
      usual_ms_(levels),
      spent_s_(levels),
      wait_s_(first_wait_s) {}

void LevelChooser::begin_with_the_cheapest() {
    level_ = usual_ms_.size() - 1;
    wait_s_ = min_wait_s;
}

void LevelChooser::fix(std::size_t level) {
    level_ = std::min(level, usual_ms_.size() - 1);
    is_fixed_ = true;
}

std::size_t LevelChooser::fitting(double ms) const {
    if (is_fixed_) return level_;
    for (std::size_t level = level_; level + 1 < usual_ms_.size(); ++level)
        if (usual_ms_[level] && *usual_ms_[level] <= ms) return level;
    return usual_ms_.size() - 1;
}

void LevelChooser::go_to(std::size_t level, MonotonicTime now) {
    if (since_) spent_s_[level_] += seconds(*since_, now);
    is_risen_to_ = level < level_;
    level_ = level;
    since_ = now;
    misfits_ = 0;
    fitting_since_.reset();
}

void LevelChooser::saw(std::size_t level, double work_ms, double time_ms, MonotonicTime now) {
    if (!since_) since_ = now;
    if (level >= usual_ms_.size()) return;
    std::optional<double>& usual_ms = usual_ms_[level];
    usual_ms = usual_ms ? *usual_ms + mean_share * (work_ms - *usual_ms) : work_ms;
    if (is_fixed_ || level != level_) return;
    const double allowed_ms = share_ * time_ms;
    misfits_ = work_ms > far_off * allowed_ms ? misfits_ + 2
               : work_ms > allowed_ms         ? misfits_ + 1
                                              : 0;
    if (misfits_ >= max_misfits && level_ + 1 < usual_ms_.size()) {
        // After a rise that did not hold, wait longer before the next one; a level that held resets
        // the wait.
        if (seconds(*since_, now) >= mistake_s)
            wait_s_ = first_wait_s;
        else if (is_risen_to_)
            wait_s_ = std::clamp(2 * wait_s_, first_wait_s, max_wait_s);
        std::size_t cheaper = level_ + 1;
        for (double ms = work_ms / untried_ratio; ms > allowed_ms && cheaper + 1 < usual_ms_.size();
             ms /= untried_ratio)
            ++cheaper;
        go_to(cheaper, now);
        return;
    }
    if (level_ == 0) return;
    const std::optional<double>& refine_ms = usual_ms_[level_ - 1];
    const double expected_ms = (level_ == 1 ? best_level_ratio_ : untried_ratio) * *usual_ms;
    const bool fits = std::min(refine_ms.value_or(expected_ms), expected_ms) <= room * allowed_ms;
    // If most of the time is the same at every level, an untried one takes less than expected, so
    // it is tried once although it is expected to take a little too long.
    const bool is_worth_a_try = !refine_ms && expected_ms <= untried_ratio * room * allowed_ms;
    if (!fits && !is_worth_a_try) {
        fitting_since_.reset();
        return;
    }
    if (!fitting_since_) fitting_since_ = now;
    if (seconds(*fitting_since_, now) >= (fits ? wait_s_ : first_wait_s)) go_to(level_ - 1, now);
}

std::vector<double> LevelChooser::shares(MonotonicTime now) const {
    std::vector<double> shares = spent_s_;
    if (since_) shares[level_] += seconds(*since_, now);
    double sum = 0;
    for (const double spent_s : shares) sum += spent_s;
    for (double& share : shares) share = sum > 0 ? share / sum : 0;
    return shares;
}

QualityRequest QualityRequest::parse(const std::string& text) {
    if (text == "auto") return {};
    if (text == "best") return {0};
    std::size_t level = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), level);
    if (fault != std::errc() || end != text.data() + text.size() || level >= render_levels().size())
        fail("--quality must be best, auto or a level from 0 (the best) to {}, but it is '{}'",
             render_levels().size() - 1, text);
    return {level};
}

double Governor::rendering_budget() const { return rendering_share_ + budget_margin; }

const PrepareLevel& Governor::prepare_sought() const {
    return prepare_levels()[prepare_.fitting(sought_ms)];
}

void Governor::saw_prepare(int rank, double ms, MonotonicTime now) {
    const bool is_cheapest = prepare_.level() + 1 == prepare_levels().size();
    prepare_.saw(static_cast<std::size_t>(rank), ms, instant_ms_, now);
    const double allowed_ms = preparing_share * instant_ms_;
    if (is_cheapest && ms > allowed_ms)
        rendering_share_ = std::max(min_rendering_share, reduction * rendering_share_);
    else if (ms < room * allowed_ms)
        rendering_share_ = std::min(full_rendering_share, recovery_factor * rendering_share_);
    render_.set_share(rendering_share_);
}

void Governor::saw_past_instant(double ms) {
    constexpr std::size_t max_samples = 5;
    past_ms_.push_back(ms);
    if (past_ms_.size() > max_samples) past_ms_.pop_front();
}

int Governor::moments_a_pulse(double speed) const {
    const double pulses = std::abs(speed);
    if (pulses == 0 || pulses >= 1 || past_ms_.empty()) return 1;
    constexpr double most_moments = 100;
    const double most = std::min(most_moments, 1 / pulses + 1e-9);
    const double fitting =
        moments_share * instant_ms_ / pulses / *std::max_element(past_ms_.begin(), past_ms_.end());
    return std::max(1, static_cast<int>(std::min(most, fitting)));
}

Governor::Governor(double rate_hz, double pulse_rate_hz, const QualityRequest& request)
    : tick_ms_(1000 / rate_hz),
      instant_ms_(1000 / pulse_rate_hz),
      reprojected_frame_ms_(std::max(tick_ms_, std::min(max_frame_ms, 0.5 * instant_ms_))),
      rendering_share_(full_rendering_share),
      render_(render_levels().size(), full_rendering_share),
      prepare_(prepare_levels().size(), preparing_share, best_preparing_ratio) {
    // The level is raised from the cheapest one, so that frames are in time from the start.
    if (!request.level) {
        render_.begin_with_the_cheapest();
        prepare_.begin_with_the_cheapest();
        return;
    }
    render_.fix(*request.level);
    prepare_.fix(*request.level);
}

}  // namespace vantage
