#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/time/time.h"
#include "common/receive/frame_set.h"
#include "common/receive/stage_step.h"
#include "common/receive/take_starter.h"

namespace vantage {

/// The fate of a frame that was given to the assembler.
enum class FrameFate {
    in_frame_set,  ///< joined the open frame set of its pulse
    late,          ///< its frame set was closed
    duplicate,     ///< the frame set already has a frame of the rig
    unsynchronized,
    out_of_step,
};

/// Joins the rigs' frames into frame sets by trigger index. A frame set opens with the first frame
/// of its pulse. It closes when every active rig has delivered the pulse or a later one, or when
/// the latency budget is used up. The budget counts from that first frame, not from the exposure:
/// it bounds the delay that one rig can cause, whatever the rigs' own latencies and the host's
/// clock are. If that first frame is more than a period ahead of most rigs' (of three or more), the
/// budget counts from when theirs are due. Frame sets close in the order of their pulses.
///
/// A single rig does not set the order for a stage of three or more: at the start no frame set
/// closes while other rigs are about to send their first frames, for a limited time. If a single
/// rig has closed frame sets that most rigs reach only after the latency budget, the order begins
/// anew.
///
/// A rig is active if it is connected, is asked for the pulse, was not silent for longer than the
/// latency budget plus two of its periods, and does not lag. A silent rig is active again with its
/// next frame. A rig lags if all of its recent frames came after the budget, until one is in time.
///
/// Frames without a pulse of the stage are never joined with another rig's. On a stage of a single
/// rig they form frame sets as they come.
///
/// Clock readings are arguments. Not thread-safe.
class FrameSetAssembler {
  public:
    struct Options {
        std::chrono::nanoseconds period;
        std::chrono::nanoseconds latency_budget;
    };

    /// Open frame sets at a time; a further one closes the oldest.
    static constexpr std::size_t max_open_frame_sets = 32;
    /// The longest wait for the first frames of other rigs after the stage's first frame, as long
    /// as a stage waits for its rigs before the first pulse.
    static constexpr std::chrono::seconds longest_gathering = TakeStarter::longest_wait;

    FrameSetAssembler(std::vector<std::string> rigs, const Options& options);

    FrameFate add(std::size_t rig, std::shared_ptr<const RigFrame> frame, MonotonicTime arrival);

    /// Appends a rig, whose number is the next one. It gets a place in frame sets with set_order().
    void add_rig(std::string name);
    /// Sets which rigs have a slot in frame sets from now on, by their numbers, and the order of
    /// the slots. Initially all rigs, in the order of their numbers. A frame of another rig still
    /// has a slot in its frame set, after the others.
    void set_order(std::vector<std::size_t> order) { order_ = std::move(order); }
    const std::vector<std::size_t>& order() const { return order_; }
    /// Changes the latency budget of frame sets that open from now on.
    void set_latency_budget(std::chrono::nanoseconds budget) { options_.latency_budget = budget; }

    /// Sets whether the rig is connected; initially not.
    void set_connected(std::size_t rig, bool connected);
    /// Sets whether the rig is about to send its first frames; initially not.
    void set_coming(std::size_t rig, bool is_coming) { rigs_[rig].is_coming = is_coming; }
    /// Sets which pulses the rig is asked for: multiples of `rate_divisor`; 0: none. Initially all.
    void set_asked(std::size_t rig, std::uint32_t rate_divisor);
    /// Sets whether the rig's trigger rate equals the stage's, as far as known; initially true.
    void set_at_stage_rate(std::size_t rig, bool is_at_it);

    /// Returns the frame sets that are closed by now, oldest first.
    std::vector<FrameSet> take_closed(MonotonicTime now);

    /// When take_closed() has to be called next; empty while no frame set is open.
    std::optional<MonotonicTime> next_deadline() const;

    /// Whether the rig counts pulses differently from the rest of the stage.
    bool is_out_of_step(std::size_t rig) const;
    /// Whether the rig's frames come so late that the host does not wait for them.
    bool lags(std::size_t rig) const;
    /// Whether the rig's recent frames have no pulse of the stage.
    bool names_no_pulse(std::size_t rig) const;

    std::size_t open_frame_sets() const { return open_.size(); }

  private:
    struct OpenFrameSet {
        std::vector<std::shared_ptr<const RigFrame>> frames;
        MonotonicTime opened{};
        MonotonicTime deadline{};
    };
    struct Rig {
        std::string name;
        bool connected = false;
        bool is_coming = false;
        std::uint32_t rate_divisor = 1;  ///< 0: asked for no frames
        std::optional<std::uint64_t> session;
        std::optional<std::uint64_t> newest;  ///< trigger index of the newest frame
        MonotonicTime heard{};                ///< when it came
        int late_in_a_row = 0;
        int unsynchronized_in_a_row = 0;
    };

    bool asked_for(std::size_t rig, std::uint64_t index) const;
    /// Until when frame sets stay open for the first frames of other rigs; empty: not at all.
    std::optional<MonotonicTime> end_of_gathering() const;
    /// Whether a single rig has closed frame sets that are far ahead of most rigs.
    bool is_order_of_one_ahead(MonotonicTime now) const;
    void begin_anew(MonotonicTime now);
    /// Gives open frame sets the time that most rigs need.
    void extend_deadlines(MonotonicTime now);
    bool in_play(std::size_t rig, std::uint64_t index, MonotonicTime now) const;
    bool everyone_accounted_for(std::uint64_t index, const OpenFrameSet& set,
                                MonotonicTime now) const;
    Absence absence(std::size_t rig, std::uint64_t index) const;
    void close_through(std::uint64_t index, MonotonicTime now);

    std::vector<Rig> rigs_;
    std::vector<std::size_t> order_;
    Options options_;
    StageStep step_;
    std::map<std::uint64_t, OpenFrameSet> open_;
    std::optional<std::uint64_t> last_closed_;
    /// Whether no frame set of two or more rigs has closed since the order began.
    bool is_order_of_one_ = true;
    std::optional<MonotonicTime> first_heard_;
    bool is_gathered_ = false;
    std::map<std::uint64_t, MonotonicTime> closed_deadlines_;  ///< of recently closed frame sets
    std::vector<FrameSet> closed_;
};

}  // namespace vantage
