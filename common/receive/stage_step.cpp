#include "common/receive/stage_step.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <tuple>

namespace vantage {
namespace {

double as_ns(std::chrono::nanoseconds duration) { return static_cast<double>(duration.count()); }

}  // namespace

StageStep::StageStep(std::size_t rigs, const Options& options) : options_(options), rigs_(rigs) {}

StageStep::Result StageStep::hear(std::size_t rig, std::uint64_t trigger_index, bool new_session,
                                  MonotonicTime arrival) {
    assert(rig < rigs_.size());
    rigs_[rig].lead_ns = static_cast<double>(trigger_index) * as_ns(options_.period) -
                         static_cast<double>(to_ns(arrival));
    rigs_[rig].heard = arrival;

    const std::optional<double> before = step_ns_;
    step_ns_ = elect(arrival);
    bool alone = true;
    for (std::size_t other = 0; other < rigs_.size(); ++other)
        alone = alone && (other == rig || !active(other, arrival));
    Result result;
    const double fall_ns = before ? *before - *step_ns_ : 0;
    result.began_anew =
        fall_ns > as_ns(options_.behind_limit) || (alone && new_session && fall_ns > 0);
    result.verdict = verdict(rig);
    return result;
}

bool StageStep::active(std::size_t rig, MonotonicTime now) const {
    return rigs_[rig].heard && now - *rigs_[rig].heard <= options_.silence_limit;
}

std::optional<MonotonicTime> StageStep::due(std::uint64_t trigger_index, MonotonicTime now) const {
    bool any_at_rate = false;
    for (std::size_t i = 0; i < rigs_.size(); ++i)
        any_at_rate = any_at_rate || (active(i, now) && rigs_[i].at_stage_rate);
    std::vector<double> leads_ns;
    for (std::size_t i = 0; i < rigs_.size(); ++i)
        if (active(i, now) && (rigs_[i].at_stage_rate || !any_at_rate))
            leads_ns.push_back(rigs_[i].lead_ns);
    if (leads_ns.size() < fewest_to_outvote) return std::nullopt;
    const auto middle = leads_ns.begin() + static_cast<std::ptrdiff_t>((leads_ns.size() - 1) / 2);
    std::nth_element(leads_ns.begin(), middle, leads_ns.end(), std::greater<>());
    // Leaves room to add a latency budget.
    constexpr double latest_ns = 9e18;
    const double due_ns = static_cast<double>(trigger_index) * as_ns(options_.period) - *middle;
    return monotonic_from_ns(static_cast<std::int64_t>(std::clamp(due_ns, 0.0, latest_ns)));
}

StageStep::Verdict StageStep::verdict(std::size_t rig) const {
    if (!rigs_[rig].heard || !step_ns_) return Verdict::in_step;
    const double ahead_ns = rigs_[rig].lead_ns - *step_ns_;
    const bool in_step =
        ahead_ns <= as_ns(options_.tolerance) && ahead_ns >= -as_ns(options_.behind_limit);
    return in_step ? Verdict::in_step : Verdict::out_of_step;
}

double StageStep::elect(MonotonicTime now) const {
    const auto agree = [&](double a, double b) {
        return std::abs(a - b) <= as_ns(options_.tolerance);
    };
    // In this order: most rigs at the stage's rate, most rigs, the current step, the largest lead.
    std::tuple<int, int, bool, double> best{0, 0, false, 0};
    for (std::size_t candidate = 0; candidate < rigs_.size(); ++candidate) {
        if (!active(candidate, now)) continue;
        const double lead_ns = rigs_[candidate].lead_ns;
        int votes = 0, votes_at_rate = 0;
        for (std::size_t other = 0; other < rigs_.size(); ++other) {
            if (!active(other, now) || !agree(rigs_[other].lead_ns, lead_ns)) continue;
            ++votes;
            votes_at_rate += rigs_[other].at_stage_rate;
        }
        const bool incumbent = step_ns_ && agree(*step_ns_, lead_ns);
        best = std::max(best, std::tuple(votes_at_rate, votes, incumbent, lead_ns));
    }
    return std::get<double>(best);
}

}  // namespace vantage
