#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host_app/foreground/motion/interpolated_frame_sets.h"
#include "host_app/frames/newest_frame_set.h"
#include "host_app/frames/replay_buffer.h"
#include "host_app/refine/gain_compensation.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Supplies the frame set that is prepared next: the newest live one, one of the past, or one
/// interpolated between two pulses of the past. Owns the reader of the feed and the replay buffer.
/// The functions that take frame sets belong to the pipeline's thread; the others are safe on any
/// thread.
class FrameSetSource {
  public:
    /// The past is that of `take`, or the replay buffer's if it is null. A buffer of 0 bytes keeps
    /// nothing. The feed is read from now on.
    FrameSetSource(StageFeed feed, std::size_t replay_bytes,
                   std::shared_ptr<const PastFrameSets> take);

    /// Returns the newest live frame set that was not taken yet; waits for one until the time is
    /// up. Throws what the feed threw.
    std::optional<FrameSet> take_live(std::chrono::nanoseconds timeout = {});

    /// A frame set of the past. With `share` above 0 it is interpolated: it lies that share of the
    /// time from its pulse to the next one.
    struct Past {
        FrameSet set;
        double share = 0;
    };
    /// Returns the frame set that is shown at `pulse`, with `moments_per_pulse` interpolated steps
    /// from one pulse to the next. Returns nothing if it is the one on screen (`shown_pulse` and
    /// `shown_share`), if the past has none, or if the same pulse was requested the last time.
    std::optional<Past> take_past(double pulse, int moments_per_pulse,
                                  std::optional<std::uint64_t> shown_pulse, double shown_share);

    bool has_take() const { return take_ != nullptr; }
    const PastFrameSets& past() const {
        return take_ ? *take_ : static_cast<const PastFrameSets&>(replay_);
    }
    /// Asks a rig to start or to stop sending.
    void ask(const std::string& rig, bool streaming) const { live_.ask(rig, streaming); }
    ReceiverStatus status() const { return live_.status(); }
    NewestFrameSet::Replaced replaced() const { return live_.replaced(); }
    /// Ends the reading of the feed, as NewestFrameSet::close().
    ReceiverStatus close() { return live_.close(); }

  private:
    std::shared_ptr<const PastFrameSets> take_;
    ReplayBuffer replay_;
    NewestFrameSet live_;
    InterpolatedFrameSets interpolated_;
    std::optional<double> requested_pulse_;  ///< the last one that take_past() looked up
};

/// Turns frame sets into depth views with corrected colours and compensated gains. Belongs to one
/// thread: the gains are estimated over time.
class FrameSetViews {
  public:
    /// `colours` is each rig's colour correction, by the rig's name.
    FrameSetViews(std::map<std::string, ColourCorrection> colours, bool compensates_gains,
                  double pulse_rate_hz)
        : colours_(std::move(colours)),
          compensates_gains_(compensates_gains),
          pulse_rate_hz_(pulse_rate_hz) {}

    /// `updates_gains`: estimate the gains from this frame set too. Frame sets of the replay buffer
    /// did so when they were live.
    std::vector<DepthView> views_of(const FrameSet& set, bool updates_gains);
    void set_colours(std::map<std::string, ColourCorrection> colours) {
        colours_ = std::move(colours);
    }
    std::map<std::string, GainCompensation::Rig> gains() const { return gains_.rigs(); }

  private:
    std::map<std::string, ColourCorrection> colours_;
    bool compensates_gains_;
    double pulse_rate_hz_;
    GainCompensation gains_;
    std::optional<std::uint64_t> last_pulse_;  ///< whose frame set updated the gains last
};

}  // namespace vantage
