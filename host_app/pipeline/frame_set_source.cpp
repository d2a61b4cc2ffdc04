#include "host_app/pipeline/frame_set_source.h"

#include <cmath>
#include <utility>

#include "common/gl/context/driver_lock.h"
#include "host_app/views/depth_view.h"

namespace vantage {
namespace {

/// Wraps the feed so that the replay buffer gets a copy, unless the buffer has no room.
StageFeed buffered(StageFeed feed, ReplayBuffer& replay, std::size_t bytes) {
    return bytes > 0 ? kept_feed(std::move(feed), replay) : feed;
}

}  // namespace

FrameSetSource::FrameSetSource(StageFeed feed, std::size_t replay_bytes,
                               std::shared_ptr<const PastFrameSets> take)
    : take_(std::move(take)),
      replay_(replay_bytes),
      live_(buffered(std::move(feed), replay_, replay_bytes)) {}

std::optional<FrameSet> FrameSetSource::take_live(std::chrono::nanoseconds timeout) {
    requested_pulse_.reset();
    return live_.take(timeout);
}

std::optional<FrameSetSource::Past> FrameSetSource::take_past(
    double pulse, int moments_per_pulse, std::optional<std::uint64_t> shown_pulse,
    double shown_share) {
    // The frame set on screen stays there, even if the replay buffer drops it meanwhile.
    if (requested_pulse_ == pulse) return std::nullopt;
    requested_pulse_ = pulse;
    const std::optional<std::uint64_t> before = past().pulse_at(pulse);
    if (!before) return std::nullopt;
    const double passed = pulse - static_cast<double>(*before);
    const double moment = 1.0 / moments_per_pulse;
    // Filmed frames take precedence: half a moment around a pulse shows the pulse itself. Where a
    // pulse is missing from the past, the one before it is shown.
    const bool is_interpolated = moments_per_pulse > 1 && passed >= moment / 2 && passed < 1;
    const double share = is_interpolated ? passed : 0;
    if (before == shown_pulse &&
        (moments_per_pulse == 1 || std::abs(share - shown_share) < 0.999 * moment))
        return std::nullopt;
    std::optional<FrameSet> set =
        is_interpolated ? interpolated_.at(past(), *before, share) : past().at(pulse);
    if (!set) return std::nullopt;
    return Past{std::move(*set), share};
}

std::vector<DepthView> FrameSetViews::views_of(const FrameSet& set, bool updates_gains) {
    const DriverLock::Pause pause;
    std::vector<DepthView> views = depth_views_of(set, colours_);
    if (!compensates_gains_) return views;
    if (updates_gains) {
        const double pulses = last_pulse_ && set.trigger_index > *last_pulse_
                                  ? static_cast<double>(set.trigger_index - *last_pulse_)
                                  : 0;
        gains_.see(views, pulses / pulse_rate_hz_);
        last_pulse_ = set.trigger_index;
    }
    for (DepthView& view : views) gains_.apply(view);
    return views;
}

}  // namespace vantage
