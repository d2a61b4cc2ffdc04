#pragma once

#include <algorithm>
#include <chrono>
#include <deque>
#include <vector>

#include "common/base/time/time.h"
#include "common/base/time/time_budget.h"

namespace vantage {

/// Durations of the last frames, from which the programme derives when to start the next one, and
/// the time budget of rendering beside instants. Not thread-safe.
class RenderTiming {
  public:
    RenderTiming(double rate_hz, MonotonicTime now)
        : period_ms_(1000 / rate_hz), budget_(budget_share, max_carried_budget, now) {}

    /// A frame took so long, with its waits.
    void add(double make_ms) {
        budget_.spend(from_s(make_ms / 1000));
        make_ms_.push_back(make_ms);
        if (make_ms_.size() > max_samples) make_ms_.pop_front();
    }
    /// Median; 0 before there are `min_samples`.
    double usual_ms() const {
        if (make_ms_.size() < min_samples) return 0;
        std::vector<double> ms(make_ms_.begin(), make_ms_.end());
        const auto middle = ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2);
        std::nth_element(ms.begin(), middle, ms.end());
        return *middle;
    }
    /// Whether frames take so long that instants get too little time beside them.
    bool are_frames_long() const { return usual_ms() >= max_render_share * period_ms_; }
    /// Whether the budget, a share of the time, allows another frame beside the instants.
    bool has_budget(double share, MonotonicTime now) {
        budget_.set_share(share);
        return budget_.has_some(now);
    }

    /// Time before a tick at which work that takes up to `longest_ms` is to be started.
    std::chrono::nanoseconds lead_of(double longest_ms) const {
        return from_s(std::min(lead_ratio * longest_ms + lead_margin_ms, period_ms_) / 1000);
    }
    /// Time before a tick at which its frame is to be started. If hardly any frame is ready at its
    /// tick, ticks show reprojections, which start later, at `reprojection_lead`.
    std::chrono::nanoseconds lead(bool can_reproject,
                                  std::chrono::nanoseconds reprojection_lead) const {
        if (make_ms_.size() < min_samples) return from_s(period_ms_ / 1000);
        if (can_reproject && usual_ms() > period_ms_) return reprojection_lead;
        return lead_of(*std::max_element(make_ms_.begin(), make_ms_.end()));
    }

  private:
    /// Number of frames that the lead is derived from. Fewer than the minimum say too little.
    static constexpr std::size_t min_samples = 20, max_samples = 200;
    /// Reserve on the longest of them.
    static constexpr double lead_ratio = 1.3, lead_margin_ms = 3;
    /// Largest share of a tick for a frame that leaves instants enough time.
    static constexpr double max_render_share = 0.75;
    /// Share of the time for frames before the first call of has_budget().
    static constexpr double budget_share = 0.75;
    static constexpr std::chrono::milliseconds max_carried_budget{200};

    double period_ms_;
    std::deque<double> make_ms_;
    TimeBudget budget_;
};

}  // namespace vantage
