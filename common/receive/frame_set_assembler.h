#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/receive/frame_set.h"
#include "common/receive/stage_step.h"

namespace vantage {

/// What became of a frame that was handed to the assembler.
enum class FrameFate {
    in_background,     ///< joined the open set of its pulse
    late,       ///< its set was closed
    duplicate,  ///< its rig is in that set already
    unsynchronized,
    out_of_step,
};

/// Joins the rigs' frames by trigger index. A set opens with the first frame of its pulse and
/// closes when every rig that is in play has delivered it or gone past it, or when the latency
/// budget is up; the budget counts from that first frame, not from the exposure, so that it bounds
/// what one rig can cost the others whatever the rigs' own latency is and however the host's clock
/// is set. Sets close in the order of their pulses. In play is a rig that is connected, is asked
/// for the pulse, was not silent for longer than the latency budget and two periods of what it is
/// asked for (it is again with its next frame), and does not lag: one whose frames have all come
/// beyond the budget for a while is not waited for until one comes within it.
///
/// Frames that name no pulse of the stage are never joined with another rig's; only on a stage of a
/// single rig are they taken as they come.
///
/// Clocks come in as arguments. Not thread-safe.
class FrameSetAssembler {
  public:
    struct Options {
        std::chrono::nanoseconds period;
        std::chrono::nanoseconds latency_budget;
    };

    /// Open sets at a time; one more closes the oldest.
    static constexpr std::size_t max_open_frame_sets = 32;

    FrameSetAssembler(std::vector<std::string> rigs, const Options& options);

    FrameFate add(std::size_t rig, std::shared_ptr<const RigFrame> frame, MonotonicTime arrival);

    /// Whether the rig gives signs of life; at first none does.
    void set_connected(std::size_t rig, bool connected);
    /// Which pulses the rig is asked for: those whose index this divides; 0: none. At first all.
    void set_asked(std::size_t rig, std::uint32_t rate_divisor);
    /// Whether the rig's pulses are as frequent as the stage's, as far as is known; at first it is
    /// taken to be so.
    void set_at_stage_rate(std::size_t rig, bool is_at_it);

    /// The sets that are closed by now, oldest first.
    std::vector<FrameSet> take_closed(MonotonicTime now);

    /// When take_closed() has to be called again at the latest; empty while no set is open.
    std::optional<MonotonicTime> next_deadline() const;

    /// Whether the rig counts pulses differently from the rest of the stage.
    bool is_out_of_step(std::size_t rig) const;
    /// Whether its frames come so late that it is not waited for.
    bool lags(std::size_t rig) const;
    /// Whether none of its frames names a pulse any more.
    bool names_no_pulse(std::size_t rig) const;

    std::size_t open_frame_sets() const { return open_.size(); }

  private:
    struct OpenFrameSet {
        std::vector<std::shared_ptr<const RigFrame>> frames;
        MonotonicTime deadline{};
    };
    struct Rig {
        std::string name;
        bool connected = false;
        std::uint32_t rate_divisor = 1;  ///< 0: no frames are asked for
        std::optional<std::uint64_t> session;
        std::optional<std::uint64_t> newest;  ///< index
        MonotonicTime heard{};                ///< when that came
        int late_in_a_row = 0;
        int unsynchronized_in_a_row = 0;
    };

    bool asked_for(std::size_t rig, std::uint64_t index) const;
    bool in_play(std::size_t rig, std::uint64_t index, MonotonicTime now) const;
    bool everyone_accounted_for(std::uint64_t index, const OpenFrameSet& set, MonotonicTime now) const;
    Absence absence(std::size_t rig, std::uint64_t index) const;
    void close_through(std::uint64_t index, MonotonicTime now);

    std::vector<Rig> rigs_;
    Options options_;
    StageStep step_;
    std::map<std::uint64_t, OpenFrameSet> open_;
    std::optional<std::uint64_t> last_closed_;
    std::map<std::uint64_t, MonotonicTime> closed_deadlines_;  ///< of the sets that closed last
    std::vector<FrameSet> closed_;
};

}  // namespace vantage
