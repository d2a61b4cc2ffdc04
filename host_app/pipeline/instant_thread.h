#pragma once

#include <condition_variable>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/time/time.h"
#include "common/gl/context/context_group.h"
#include "common/gl/context/render_priority.h"
#include "host_app/pipeline/frame_set_source.h"
#include "host_app/pipeline/instant_stats.h"
#include "host_app/pipeline/preparer_pool.h"

namespace vantage {

/// A prepared instant with the frame set that it was made from. Immutable.
struct ReadyInstant {
    /// Owns the instant's textures and buffers. It is destroyed on its own thread once nobody holds
    /// one of its instants. First member, so that it is released last.
    std::shared_ptr<const InstantPreparer> preparer;
    std::shared_ptr<const Instant> instant;
    std::shared_ptr<const FrameSet> set;
    double share = 0;  ///< above 0: interpolated, that share of the time to the next pulse
    std::optional<TaiTime> exposure;  ///< the earliest of its frames
    std::uint64_t generation = 0;     ///< of the contexts that can render it
    std::uint64_t number = 0;         ///< grows with every instant and with every refinement of one
    std::string synthesiser;          ///< it was prepared for this one
    bool is_live = true;
    MonotonicTime taken_up{};  ///< when the thread began to fetch its frame set
    double fetch_ms = 0;       ///< from then until the frame set was decoded
    double prepare_ms = 0;
};

/// Selects what the pipeline prepares next.
struct InstantRequest {
    /// The newest frame set of the past that is not later than this pulse. Empty: what arrives
    /// live.
    std::optional<double> pulse;
    /// How many moments of a pulse of the past are prepared at most; those between two pulses are
    /// interpolated. 1: pulses only.
    int moments_per_pulse = 1;
    bool is_held = false;  ///< prepare no new frame set; refine the one that is shown
    VirtualView target;    ///< the rigs that this view needs are prepared
    PrepareLevel level;
    /// Number of jumps in time so far. A new jump cancels an instant that was requested before it.
    std::uint64_t jumps = 0;
    /// The view of a second camera. The rigs that it needs keep sending, and at the best level they
    /// are prepared too.
    std::optional<VirtualView> preview = {};
};

/// The preparation stage of the pipeline, on the pulses' clock: prepares the newest frame set, or
/// the requested one of the past, for rendering. Runs on a thread and a context of its own, and
/// draws in slices of a few milliseconds so that renderers on other threads are not delayed. All
/// functions are safe on any thread.
class InstantThread {
  public:
    struct Settings {
        double pulse_rate_hz = 30;
        std::size_t replay_bytes = 0;
        bool compensate_gains = true;
        std::map<std::string, ColourCorrection> colours = {};  ///< by rig
        /// A take to play instead of the replay buffer; its frame sets are learnt from. Null: the
        /// past is the replay buffer's.
        std::shared_ptr<const PastFrameSets> take = nullptr;
        /// The background that rigs begin with where it fits; null: with none.
        std::shared_ptr<const Background> background = nullptr;
    };
    /// `contexts` must outlive the thread. The feed is read from now on.
    InstantThread(Settings settings, StageFeed feed, ContextGroup& contexts);
    ~InstantThread();
    InstantThread(const InstantThread&) = delete;
    InstantThread& operator=(const InstantThread&) = delete;

    /// Prepares instants for this synthesiser from now on.
    void prepare_for(const std::string& synthesiser, MakePreparer make);
    void request(const InstantRequest& request);
    /// Learns the background from nothing, beginning with the next instant.
    void learn_background_anew();
    /// Corrects the rigs' colours by these from now on, in place of Settings::colours.
    void set_colours(std::map<std::string, ColourCorrection> colours);
    /// Returns the background as learnt until now. The future holds an Error if there is none.
    std::future<Background> background();
    /// Returns the newest instant; null before the first. Throws what the feed threw.
    std::shared_ptr<const ReadyInstant> newest() const;

    std::optional<PastFrameSets::Span> past_span() const { return source_.past().span(); }
    std::optional<std::uint64_t> past_pulse_at(double pulse) const {
        return source_.past().pulse_at(pulse);
    }
    ReceiverStatus status() const { return source_.status(); }
    /// The contexts that can render the instants.
    ContextGroup& contexts() { return *contexts_; }
    /// Preparation waits while a renderer with a deadline claims this.
    RenderPriority& render_priority() { return render_priority_; }

    using Stats = InstantStats;
    Stats stats() const { return stats_.snapshot(source_.replaced()); }
    /// Stops reading the feed and waits until the frame set in preparation is done, so that the
    /// stats are complete. Frame sets that were never taken count as replaced.
    ReceiverStatus close();

  private:
    class Loop;  ///< what the thread alone uses

    struct Maker {
        std::string synthesiser;
        MakePreparer make;
    };

    Settings settings_;
    ContextGroup* contexts_;
    RenderPriority render_priority_;
    FrameSetSource source_;
    InstantStatsRecorder stats_;

    mutable std::mutex mutex_;  ///< guards the members below
    std::condition_variable stop_requested_;
    std::condition_variable round_begun_;
    bool is_stopping_ = false;
    std::uint64_t rounds_ = 0;  ///< of the loop; each begins with no frame set in preparation
    Maker maker_;
    InstantRequest request_;
    bool learns_anew_ = false;
    std::optional<std::map<std::string, ColourCorrection>> new_colours_;  ///< not taken yet
    std::vector<std::promise<Background>> background_requests_;
    std::shared_ptr<const ReadyInstant> newest_;
    std::exception_ptr failure_;  ///< what the feed threw
    std::thread thread_;
};

}  // namespace vantage
