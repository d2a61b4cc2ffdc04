#include "host_app/pipeline/instant_thread.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/time/time_budget.h"
#include "common/base/trace/trace.h"
#include "common/gl/context/context_loss.h"
#include "common/gl/context/driver_lock.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/fence.h"
#include "common/gl/sliced_drawing.h"
#include "host_app/pipeline/rig_demand.h"
#include "host_app/refine/multi_view_refinement.h"

namespace vantage {
namespace {

/// Longest time that one slice of drawing may delay a frame on another context.
constexpr std::chrono::milliseconds slice{4};
/// Least share of the time for preparation while frames are rendered beside it: without it a
/// renderer that is always late would leave no time for new instants.
constexpr double min_preparing_share = 0.4;
/// Longest wait for a frame set before the thread looks at the request again.
constexpr std::chrono::milliseconds poll_period{5};
/// Longest time that close() waits for the instant in preparation.
constexpr std::chrono::seconds max_closing_time{10};
/// Pause after a fault before the preparer is made anew.
constexpr std::chrono::milliseconds recovery_pause{200};
/// Least time between two checks whether a held instant can be prepared better.
constexpr std::chrono::milliseconds refinement_period{100};
/// The background is refined when no frame set waits. A computer that always has one waiting
/// spends this share of the time on it too; unused time counts for so long.
constexpr double min_refining_share = 0.1;
constexpr std::chrono::milliseconds refining_memory{200};
/// Instants that lie further apart do not follow each other: nothing that moves is tracked across.
constexpr double max_gap_s = 1;

/// Ends preparation when the request has jumped in time meanwhile.
struct JumpedInTime {};

/// Also those whose frame is missing.
std::set<std::string> rigs_of(const FrameSet& set) {
    std::set<std::string> rigs;
    for (const FrameSet::Slot& slot : set.slots) rigs.insert(slot.rig);
    return rigs;
}

std::optional<TaiTime> earliest_exposure(const FrameSet& set) {
    std::optional<TaiTime> exposure;
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame && (!exposure || slot.frame->exposure < *exposure))
            exposure = slot.frame->exposure;
    return exposure;
}

/// Whether preparing for `request` would give another or a better instant than for `before`.
bool differs(const InstantRequest& request, const InstantRequest& before) {
    const auto is_elsewhere = [](const VirtualView& view, const VirtualView& other) {
        return !view.world_from_camera.isApprox(other.world_from_camera, 1e-6);
    };
    return request.level.rank < before.level.rank || is_elsewhere(request.target, before.target) ||
           (request.preview &&
            (!before.preview || is_elsewhere(*request.preview, *before.preview)));
}

/// Adds copies of a view, moved aside, until there are as many views as `rigs` or as refinement
/// compares. Shaders differ by the number of compared rigs, and all of them are compiled at warm-up
/// even if some rigs are not there yet.
std::vector<DepthView> padded_for_warm_up(std::vector<DepthView> views, std::size_t rigs) {
    // Further apart than a rig's own two cameras, or the comparison would be left out.
    constexpr double apart_baselines = 5;
    const std::size_t compared = std::min(rigs, MultiViewRefinement::max_others + 1);
    while (!views.empty() && views.size() < compared) {
        DepthView twin = views.back();
        twin.name += "'";
        twin.world_from_camera.translate(Eigen::Vector3d(apart_baselines * twin.baseline_m, 0, 0));
        views.push_back(std::move(twin));
    }
    return views;
}

/// Returns `first` with the rigs that only `second` has appended.
std::shared_ptr<const Instant> joined(std::shared_ptr<const Instant> first, const Instant& second) {
    std::vector<InstantRig> more;
    for (const InstantRig& rig : second.rigs)
        if (std::none_of(first->rigs.begin(), first->rigs.end(),
                         [&](const InstantRig& other) { return other.surface == rig.surface; }))
            more.push_back(rig);
    if (more.empty()) return first;
    auto both = std::make_shared<Instant>(*first);
    both->rigs.insert(both->rigs.end(), more.begin(), more.end());
    return both;
}

}  // namespace

/// The thread's loop and the state that it alone uses, which outlives a fault.
class InstantThread::Loop {
  public:
    explicit Loop(InstantThread& owner)
        : owner_(owner),
          settings_(owner.settings_),
          views_(settings_.colours, settings_.compensate_gains, settings_.pulse_rate_hz),
          preparers_(*owner.contexts_, settings_.background) {}

    /// Runs until the thread is stopped. After a fault everything on the GPU is made anew.
    void run();

  private:
    void prepare_until_stopped();
    /// Reads what is requested. Returns false if the thread is to stop.
    bool begin_round(InstantRequest& request, Maker& maker);
    /// Prepares a frame set, or refines, or waits for a short time.
    void run_round(const InstantRequest& request);
    void answer_background_requests();
    /// Changes to the requested synthesiser and prepares the shown frame set for it.
    void change_synthesiser(const Maker& maker, const InstantRequest& request,
                            const ShaderLibrary& shaders);
    /// Returns the frame set to prepare next, or nothing after a short wait.
    std::optional<FrameSetSource::Past> next_set(const InstantRequest& request);
    std::optional<FrameSet> take_live();
    /// Compiles the shaders with the first frame set. That takes seconds: a newer live frame set
    /// that arrived meanwhile replaces it.
    void warm_up(FrameSet& set, const InstantRequest& request);
    void prepare_set(FrameSetSource::Past next, const InstantRequest& request,
                     MonotonicTime taken_up);
    /// Prepares the shown instant again if the request asks for a better or another one.
    void refine_shown(const InstantRequest& request);
    /// Returns true if more is left to do.
    bool refine_background(const InstantRequest& request);
    /// Asks the rigs that the views need to send, and the others to stop.
    void ask_for_rigs(std::span<const DepthView> views, const InstantRequest& request);
    /// Prepares `ready` for the request and makes it the newest instant.
    void publish(ReadyInstant ready, const InstantRequest& request, MonotonicTime start);
    /// Does the work and returns true; or returns false if a jump in time cancelled it.
    template <class Work>
    bool unless_time_jumps(const InstantRequest& request, const Work& work);
    void cancel_if_time_jumped() const;
    void wait_briefly();

    InstantThread& owner_;
    const Settings& settings_;
    FrameSetViews views_;
    RigDemand demand_;
    PreparerPool preparers_;
    std::shared_ptr<InstantPreparer> preparer_;  ///< null: none was asked for yet
    ReadyInstant last_;                          ///< the newest instant
    std::optional<double> last_pulse_;           ///< with its share; of the last frame set taken
    std::optional<InstantRequest> prepared_;     ///< what the newest instant was prepared for
    MonotonicTime refined_{};                    ///< when refine_shown() ran last
    TimeBudget refining_{min_refining_share, refining_memory, MonotonicClock::now()};
    bool is_retaking_ = false;  ///< a new preparer is taking the shown frame set
    bool is_warmed_up_ = false;
    /// The jump count of the work in progress, which a further jump cancels; empty: none does.
    std::optional<std::uint64_t> cancelling_jumps_;
    std::uint64_t prepared_jumps_ = 0;  ///< jump count of the last frame set's request
};

InstantThread::InstantThread(Settings settings, StageFeed feed, ContextGroup& contexts)
    : settings_(std::move(settings)),
      contexts_(&contexts),
      source_(std::move(feed), settings_.replay_bytes, settings_.take),
      thread_([this] { Loop(*this).run(); }) {}

InstantThread::~InstantThread() {
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = true;
    }
    stop_requested_.notify_all();
    thread_.join();
}

void InstantThread::prepare_for(const std::string& synthesiser, MakePreparer make) {
    const std::lock_guard lock(mutex_);
    maker_ = {synthesiser, std::move(make)};
}

void InstantThread::request(const InstantRequest& request) {
    const std::lock_guard lock(mutex_);
    request_ = request;
}

void InstantThread::learn_background_anew() {
    const std::lock_guard lock(mutex_);
    learns_anew_ = true;
}

void InstantThread::set_colours(std::map<std::string, ColourCorrection> colours) {
    const std::lock_guard lock(mutex_);
    new_colours_ = std::move(colours);
}

std::future<Background> InstantThread::background() {
    const std::lock_guard lock(mutex_);
    return background_requests_.emplace_back().get_future();
}

std::shared_ptr<const ReadyInstant> InstantThread::newest() const {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    return newest_;
}

ReceiverStatus InstantThread::close() {
    ReceiverStatus status = source_.close();
    // The round in progress may have taken a frame set before the feed was closed; when the round
    // after the next begins, none is left in preparation.
    std::unique_lock lock(mutex_);
    const std::uint64_t before = rounds_;
    round_begun_.wait_for(lock, max_closing_time,
                          [&] { return is_stopping_ || rounds_ >= before + 2; });
    return status;
}

void InstantThread::Loop::run() {
    name_this_thread("instants");
    std::uint64_t lost_generation = 0;  // 0: none
    for (;;) {
        try {
            owner_.contexts_->renew(lost_generation);
            prepare_until_stopped();
            return;
        } catch (const ContextLost& error) {
            log_warning("the GPU was reset and instants are prepared anew: {}", error.what());
            if (preparers_.generation() > 0) lost_generation = preparers_.generation();
        } catch (const std::exception& error) {
            log_error("an instant could not be prepared; its preparer is made anew: {}",
                      error.what());
        }
        owner_.stats_.note_fault();
        preparer_.reset();
        prepared_.reset();
        std::unique_lock lock(owner_.mutex_);
        if (owner_.stop_requested_.wait_for(lock, recovery_pause,
                                            [&] { return owner_.is_stopping_; }))
            return;
    }
}

void InstantThread::Loop::prepare_until_stopped() {
    const ContextGroup::Member member = preparers_.join(last_.synthesiser);
    const DriverLock turn(owner_.contexts_->driver());
    const CurrentContext current(*member.context);
    require_context("instants were prepared");
    const SlicedDrawing slices(
        slice, &owner_.render_priority_, [this] { cancel_if_time_jumped(); }, min_preparing_share);
    const ShaderLibrary shaders;
    InstantRequest request;
    Maker maker;
    while (begin_round(request, maker)) {
        if (owner_.contexts_->generation() != member.generation)
            throw ContextLost("another thread found the GPU reset");
        preparers_.release_unused();
        answer_background_requests();
        if (maker.make && (!preparer_ || last_.synthesiser != maker.synthesiser))
            change_synthesiser(maker, request, shaders);
        if (preparer_)
            run_round(request);
        else
            wait_briefly();
    }
    // Instants that others still hold keep their preparer; the rest ends on this context.
    {
        const std::lock_guard lock(owner_.mutex_);
        owner_.newest_.reset();
    }
    last_ = {};
    preparer_.reset();
    preparers_.clear();
}

bool InstantThread::Loop::begin_round(InstantRequest& request, Maker& maker) {
    const std::lock_guard lock(owner_.mutex_);
    if (owner_.is_stopping_) return false;
    ++owner_.rounds_;
    owner_.round_begun_.notify_all();
    request = owner_.request_;
    maker = owner_.maker_;
    if (owner_.new_colours_) views_.set_colours(*std::exchange(owner_.new_colours_, std::nullopt));
    return true;
}

void InstantThread::Loop::run_round(const InstantRequest& request) {
    MonotonicTime taken_up = MonotonicClock::now();
    if (std::optional<FrameSetSource::Past> next = next_set(request)) {
        if (!is_warmed_up_) {
            warm_up(next->set, request);
            taken_up = MonotonicClock::now();
        }
        prepare_set(std::move(*next), request, taken_up);
    } else if (request.pulse || request.is_held) {
        refine_shown(request);
    } else if (prepared_) {
        refine_background(request);
    }
}

void InstantThread::Loop::answer_background_requests() {
    bool learns_anew = false;
    std::vector<std::promise<Background>> requests;
    {
        const std::lock_guard lock(owner_.mutex_);
        learns_anew = std::exchange(owner_.learns_anew_, false);
        requests = std::exchange(owner_.background_requests_, {});
    }
    BackgroundAccess* access = preparer_ ? preparer_->background_access() : nullptr;
    if (learns_anew) preparers_.learn_background_anew();
    for (std::promise<Background>& request : requests) {
        try {
            if (preparer_ && !access)
                fail(
                    "the synthesiser {} learns no background: choose another with --synth or the "
                    "F2 key",
                    last_.synthesiser);
            Background background = access ? access->learnt() : Background();
            if (background.rigs.empty())
                fail(
                    "nothing is known of the background yet, since no rig has shown any: wait for "
                    "the first frames");
            request.set_value(std::move(background));
        } catch (const ContextLost&) {
            request.set_exception(std::make_exception_ptr(
                Error("the GPU was reset while the background was read from it: save it again")));
            throw;
        } catch (...) {
            request.set_exception(std::current_exception());
        }
    }
}

void InstantThread::Loop::change_synthesiser(const Maker& maker, const InstantRequest& request,
                                             const ShaderLibrary& shaders) {
    preparer_ = preparers_.preparer_of(maker.synthesiser, maker.make, shaders);
    last_.synthesiser = maker.synthesiser;
    last_pulse_.reset();
    prepared_.reset();
    // Tried once: if it fails, the next frame set is prepared instead.
    if (last_.set && !std::exchange(is_retaking_, true)) {
        const MonotonicTime start = MonotonicClock::now();
        preparer_->cut();
        preparer_->take(views_.views_of(*last_.set, false), 0);
        publish(last_, request, start);
        prepared_ = request;
    }
    is_retaking_ = false;
}

std::optional<FrameSetSource::Past> InstantThread::Loop::next_set(const InstantRequest& request) {
    const DriverLock::Pause pause;
    if (!request.pulse && !request.is_held) {
        std::optional<FrameSet> set = take_live();
        if (!set) return std::nullopt;
        return FrameSetSource::Past{std::move(*set), 0};
    }
    if (request.pulse) {
        // After a cancelled preparation the preparer holds a part of another frame set: then the
        // shown one is taken again too.
        const std::optional<std::uint64_t> shown =
            prepared_ && last_.set ? std::optional(last_.set->trigger_index) : std::nullopt;
        if (auto past = owner_.source_.take_past(*request.pulse, request.moments_per_pulse, shown,
                                                 last_.share))
            return past;
    }
    wait_briefly();
    return std::nullopt;
}

std::optional<FrameSet> InstantThread::Loop::take_live() {
    try {
        return owner_.source_.take_live(poll_period);
    } catch (...) {
        const std::lock_guard lock(owner_.mutex_);
        owner_.failure_ = std::current_exception();
        owner_.is_stopping_ = true;
        return std::nullopt;
    }
}

void InstantThread::Loop::wait_briefly() {
    const DriverLock::Pause pause;
    std::unique_lock lock(owner_.mutex_);
    owner_.stop_requested_.wait_for(lock, poll_period, [&] { return owner_.is_stopping_; });
}

void InstantThread::Loop::warm_up(FrameSet& set, const InstantRequest& request) {
    owner_.stats_.begin(set);
    preparer_->warm_up(padded_for_warm_up(views_.views_of(set, false), set.slots.size()),
                       request.target);
    is_warmed_up_ = true;
    if (!request.pulse) {
        if (std::optional<FrameSet> newer = owner_.source_.take_live()) {
            owner_.stats_.drop();
            set = std::move(*newer);
        }
    }
    owner_.stats_.cancel();
}

void InstantThread::Loop::prepare_set(FrameSetSource::Past next, const InstantRequest& request,
                                      MonotonicTime taken_up) {
    TraceSpan span("instant");
    span.with("pulse", static_cast<std::int64_t>(next.set.trigger_index))
        .in(TraceId::of_frame_set(next.set.trigger_index), TraceFlow::passes);
    const MonotonicTime start = MonotonicClock::now();
    const bool is_live = !request.pulse;
    const bool is_counted = next.share == 0 && (is_live || owner_.source_.has_take());
    if (is_counted) owner_.stats_.begin(next.set);
    const double pulse = static_cast<double>(next.set.trigger_index) + next.share;
    // Time may run backwards; that is no cut.
    const double dt_s =
        last_pulse_ ? std::abs(pulse - *last_pulse_) / settings_.pulse_rate_hz : 2 * max_gap_s;
    if (dt_s > max_gap_s) preparer_->cut();
    last_pulse_ = pulse;
    const std::vector<DepthView> views = views_.views_of(next.set, is_counted);
    // While the past is shown, the camera says nothing about the rigs that are needed live.
    if (is_live) {
        demand_.forget_others(next.set);
        preparer_->keep_only(rigs_of(next.set));
        ask_for_rigs(views, request);
    }
    const auto prepare = [&] {
        TraceSpan taking("take views");
        preparer_->take(views, std::min(dt_s, max_gap_s));
        taking.end();
        ReadyInstant ready = last_;
        ready.set = std::make_shared<const FrameSet>(std::move(next.set));
        ready.share = next.share;
        ready.exposure = earliest_exposure(*ready.set);
        ready.is_live = is_live;
        ready.taken_up = taken_up;
        ready.fetch_ms = to_ms(start - taken_up);
        publish(std::move(ready), request, start);
    };
    // The first frame set after a jump is always finished, so that a jog shows what it passes.
    const bool follows_jump = std::exchange(prepared_jumps_, request.jumps) != request.jumps;
    if (follows_jump) {
        prepare();
    } else if (!unless_time_jumps(request, prepare)) {
        owner_.stats_.drop();
        prepared_.reset();
        return;
    }
    prepared_ = request;
    const BackgroundAccess* background = preparer_->background_access();
    owner_.stats_.note_prepared(
        {.set = *last_.set,
         .is_counted = is_counted,
         .is_interpolated = last_.share > 0,
         .prepare_ms = last_.prepare_ms,
         .gain_compensation = views_.gains(),
         .backgrounds = background ? background->states() : std::vector<RigBackgroundState>()});
    while (is_live &&
           (refining_.has_some(MonotonicClock::now()) || preparer_->is_improvement_urgent()) &&
           refine_background(request))
        continue;
}

void InstantThread::Loop::refine_shown(const InstantRequest& request) {
    const MonotonicTime start = MonotonicClock::now();
    if (!prepared_ || !differs(request, *prepared_) || start - refined_ <= refinement_period)
        return;
    if (unless_time_jumps(request, [&] { publish(last_, request, start); })) prepared_ = request;
    refined_ = start;
}

bool InstantThread::Loop::refine_background(const InstantRequest& request) {
    const TraceSpan span("background step");
    const MonotonicTime start = MonotonicClock::now();
    bool has_more = false;
    (void)unless_time_jumps(request, [&] { has_more = preparer_->improve_a_step(request.target); });
    refining_.spend(MonotonicClock::now() - start);
    return has_more;
}

void InstantThread::Loop::ask_for_rigs(std::span<const DepthView> views,
                                       const InstantRequest& request) {
    demand_.see(views);
    if (request.target.width_px == 0) return;
    std::vector<VirtualView> targets{request.target};
    if (request.preview) targets.push_back(*request.preview);
    for (const RigDemand::Change& change : demand_.update(targets, MonotonicClock::now())) {
        log_info("asking rig {} to {} sending", change.rig, change.streaming ? "start" : "stop");
        owner_.source_.ask(change.rig, change.streaming);
    }
}

void InstantThread::Loop::publish(ReadyInstant ready, const InstantRequest& request,
                                  MonotonicTime start) {
    TraceSpan preparing("prepare");
    preparing.with("level", request.level.rank);
    ready.instant = preparer_->prepare(request.target, request.level);
    preparing.end();
    if (request.preview && request.level.rank == 0)
        ready.instant = joined(ready.instant, *preparer_->prepare(*request.preview, request.level));
    ready.preparer = preparer_;
    ready.generation = preparers_.generation();
    TraceSpan waiting("fence wait");
    Fence::insert().wait("an instant was waited for");
    waiting.end();
    check_gl("preparing an instant");
    ready.prepare_ms = ms_since(start);
    ++ready.number;
    last_ = std::move(ready);
    const std::lock_guard lock(owner_.mutex_);
    owner_.newest_ = std::make_shared<const ReadyInstant>(last_);
}

template <class Work>
bool InstantThread::Loop::unless_time_jumps(const InstantRequest& request, const Work& work) {
    bool is_done = true;
    cancelling_jumps_ = request.jumps;
    try {
        work();
    } catch (const JumpedInTime&) {
        is_done = false;
    } catch (...) {
        // Nothing cancels what is made anew after a fault.
        cancelling_jumps_.reset();
        throw;
    }
    cancelling_jumps_.reset();
    return is_done;
}

void InstantThread::Loop::cancel_if_time_jumped() const {
    if (!cancelling_jumps_) return;
    const std::lock_guard lock(owner_.mutex_);
    if (owner_.request_.jumps != *cancelling_jumps_) throw JumpedInTime();
}

}  // namespace vantage
