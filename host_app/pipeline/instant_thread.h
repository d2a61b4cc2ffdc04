#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/percentiles.h"
#include "common/base/time/time.h"
#include "common/gl/context/context_group.h"
#include "common/gl/context/render_priority.h"
#include "host_app/foreground/motion/interpolated_frame_sets.h"
#include "host_app/frames/newest_frame_set.h"
#include "host_app/frames/replay_buffer.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/pipeline/rig_demand.h"
#include "host_app/refine/gain_compensation.h"

namespace vantage {

/// An instant with the frame set that it was made of. Immutable.
struct ReadyInstant {
    /// Whose textures and buffers it consists of: destroyed on its own thread, once nobody holds an
    /// instant of it. The first, so that it is let go last.
    std::shared_ptr<const InstantPreparer> preparer;
    std::shared_ptr<const Instant> instant;
    std::shared_ptr<const FrameSet> set;
    double share = 0;  ///< of the time to the next pulse, where it was made of the sets of both
    std::optional<TaiTime> exposure;  ///< the earliest of its frames
    std::uint64_t generation = 0;     ///< of the contexts that can render it
    std::uint64_t number = 0;         ///< grows with every instant, also with one that is bettered
    std::string synthesiser;          ///< that it was prepared for
    bool is_live = true;
    MonotonicTime taken_up{};  ///< when its set began to be fetched
    double fetch_ms = 0;       ///< until its set was there, decoded
    double prepare_ms = 0;
};

/// What the programme wants of the pulses' clock.
struct InstantRequest {
    /// Of the replay buffer: the newest set that is not later; nothing: what arrives.
    std::optional<double> pulse;
    /// Of the past: moments of a pulse that are made ready at most; those between two pulses are
    /// made of what moved from one to the other. 1: pulses only.
    int moments_a_pulse = 1;
    bool is_held = false;  ///< nothing new; what is shown is bettered
    VirtualView target;    ///< rigs that it needs are prepared
    PrepareLevel level;
    std::uint64_t jumps = 0;  ///< in time, until now: an instant of before the last gives way
    /// Of a second camera: rigs that it needs are not asked to stop, and at the best level they are
    /// prepared too.
    std::optional<VirtualView> preview = {};
};

/// What the steps of a frame's way took at the rigs.
struct RigSteps {
    Percentiles capture_ms, rectify_ms, match_ms, pack_ms;
};

using MakePreparer = std::function<std::unique_ptr<InstantPreparer>(const ShaderLibrary&)>;

/// The pulses' clock: makes the newest frame set, or the one that is asked for, ready to be
/// rendered, on a thread and a context of its own and in slices of a few milliseconds, so that
/// whoever renders meanwhile is not held up. What is learnt along time lives here.
class InstantThread {
  public:
    struct Settings {
        double pulse_rate_hz = 30;
        std::size_t replay_bytes = 0;
        bool compensate_gains = true;
        std::map<std::string, ColourCorrection> colours = {};  ///< by rig
        /// Of a take, from which all is shown and learnt; null: the replay buffer's.
        std::shared_ptr<const PastFrameSets> take = nullptr;
        /// That rigs begin with, where it fits; null: with nothing.
        std::shared_ptr<const Background> set = nullptr;
    };
    /// `contexts` must outlive it. `feed` is read from now on.
    InstantThread(Settings settings, StageFeed feed, ContextGroup& contexts);
    ~InstantThread();
    InstantThread(const InstantThread&) = delete;
    InstantThread& operator=(const InstantThread&) = delete;

    /// From now on instants are prepared for this synthesiser.
    void prepare_for(const std::string& synthesiser, MakePreparer make);
    void request(const InstantRequest& request);
    /// From the next instant on: what the rigs see is the set, whatever was known of it.
    void learn_background_anew();
    /// What was learnt of the set until now, soon; Error where nothing was.
    std::future<Background> background();
    /// The newest that is ready; null before the first. Throws what the feed threw.
    std::shared_ptr<const ReadyInstant> newest() const;

    std::optional<PastFrameSets::Span> past_span() const { return past().span(); }
    std::optional<std::uint64_t> past_pulse_at(double pulse) const {
        return past().pulse_at(pulse);
    }
    ReceiverStatus status() const { return sets_.status(); }
    /// Those that can render what is prepared.
    ContextGroup& contexts() { return *contexts_; }
    /// Who renders against a clock claims it, and preparing waits.
    RenderPriority& render_priority() { return way_; }

    struct Stats {
        std::uint64_t prepared = 0;        ///< live sets, or a take's
        std::uint64_t between = 0;         ///< of moments between pulses
        RigCounts frames;                  ///< of them
        NewestFrameSet::Replaced superseded;  ///< also what could not be prepared for a fault
        std::map<std::string, GainCompensation::Rig> gain_compensation;
        Percentiles prepare_ms;
        RigSteps rig_steps;
        std::vector<RigBackgroundState> sets;  ///< empty: none are learnt
        int faults = 0;
    };
    Stats stats() const;
    /// Ends the reading, and waits for what is being prepared, so that the books are complete;
    /// whatever nobody took counts as superseded.
    ReceiverStatus close();

  private:
    struct Maker {
        std::string synthesiser;
        MakePreparer make;
    };
    const PastFrameSets& past() const {
        return settings_.take ? *settings_.take : static_cast<const PastFrameSets&>(replay_);
    }
    /// Preparers with the context that their objects live on.
    struct Generation {
        ContextGroup::Member member;
        /// By synthesiser. Kept when another takes over: drivers give back little of what one has
        /// taken, and what was learnt of the set stays known.
        std::map<std::string, std::shared_ptr<InstantPreparer>> preparers;
        std::vector<std::shared_ptr<InstantPreparer>> retired;  ///< after a fault
    };
    void run();
    void prepare_instants();
    /// With the first set. That takes seconds: where a newer one came meanwhile, `set` is that.
    void warm_up(InstantPreparer& preparer, FrameSet& set, const InstantRequest& request);
    /// Counts what was prepared last.
    void note_prepared(bool is_counted, const BackgroundAccess* memory);
    /// As superseded. Precondition: mutex_ is held.
    void count_unprepared();
    /// Answers what was asked of the set.
    void tend_background(InstantPreparer* preparer);
    /// Does the work, or as much of it as was done when time jumped to elsewhere: then false.
    bool unless_time_jumps(const InstantRequest& request, const std::function<void()>& work);
    /// Throws GaveWay where time has jumped.
    void give_way_to_jump() const;
    /// Destroys those of lost generations, and retired ones, that nobody holds instants of any
    /// more.
    void let_go_of_preparers();
    /// Makes the synthesiser's preparer where there is none yet.
    std::shared_ptr<InstantPreparer> preparer_of(const Maker& maker, const ShaderLibrary& shaders);
    /// `share`: that of ReadyInstant.
    std::optional<FrameSet> next_set(const InstantRequest& request, std::uint64_t shown_pulse,
                                     double& share);
    /// Of the past, what is wished for, unless it is shown.
    std::optional<FrameSet> past_frame_set(const InstantRequest& request, std::uint64_t shown_pulse,
                                     double& share);
    std::vector<DepthView> views_of(const FrameSet& set, bool is_counted);
    /// Asks the rigs that the views need to send, and the others to stop.
    void ask_for_rigs(std::span<const DepthView> views, const InstantRequest& request);
    /// `ready` but for its instant, which is prepared.
    void publish(ReadyInstant ready, const InstantRequest& request,
                 const std::shared_ptr<InstantPreparer>& preparer, MonotonicTime start);

    Settings settings_;
    ContextGroup* contexts_;
    RenderPriority way_;
    ReplayBuffer replay_;
    NewestFrameSet sets_;
    GainCompensation gain_compensation_;       ///< of the thread
    RigDemand demand_;                  ///< of the thread
    InterpolatedFrameSets between_;               ///< of the thread
    std::optional<double> last_pulse_;  ///< with the share of it that had passed
    std::optional<std::uint64_t> last_compensated_;
    std::optional<double> fetched_;        ///< the pulse that was looked up in the past last
    std::vector<Generation> generations_;  ///< of the thread; all but the last are lost
    bool is_retaking_ = false;             ///< of the thread: a new preparer takes what is shown
    bool is_warmed_up_ = false;            ///< of the thread: with the first set
    ReadyInstant last_;                    ///< of the thread: what was prepared last
    std::optional<FrameSet> unprepared_;   ///< of the thread: the live set that is being prepared
    std::optional<std::uint64_t> jumps_;   ///< of the thread: what it does gives way to the next
    std::uint64_t fetched_jumps_ = 0;      ///< of the thread: until the last set was wished for

    mutable std::mutex mutex_;
    std::condition_variable woken_;
    Maker maker_;
    InstantRequest request_;
    bool learns_anew_ = false;
    std::vector<std::promise<Background>> asked_for_background_;
    bool is_stopping_ = false;
    std::uint64_t looks_ = 0;  ///< at what is wished, each with nothing in hand
    std::condition_variable looked_;
    std::shared_ptr<const ReadyInstant> newest_;
    std::exception_ptr failure_;
    Stats stats_;
    NewestFrameSet::Replaced failed_;
    PercentileRecorder prepare_ms_, capture_ms_, rectify_ms_, match_ms_, pack_ms_;
    std::thread thread_;
};

}  // namespace vantage
