#include "host_app/pipeline/instant_thread.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/time/time.h"
#include "common/base/time/time_budget.h"
#include "common/gl/context/context_loss.h"
#include "common/gl/context/driver_lock.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/fence.h"
#include "common/gl/sliced_drawing.h"
#include "host_app/refine/multi_view_refinement.h"
#include "host_app/views/depth_views.h"

namespace vantage {
namespace {

/// What a slice may hold up another context's picture for.
constexpr std::chrono::milliseconds slice{4};
/// Of the time, while pictures are rendered beside.
constexpr double least_preparing = 0.4;
/// How long the thread waits for a set before it looks at what is wished.
constexpr std::chrono::milliseconds patience{5};
/// For an instant, at the end.
constexpr std::chrono::seconds longest_preparation{10};
/// After a fault, before everything is made anew.
constexpr std::chrono::milliseconds recovery{200};
/// Between two looks at whether what is held could be better.
constexpr std::chrono::milliseconds refinements{100};
/// A set is bettered when no instant waits; but a computer that is never done with them does it
/// too, for this share of the time. What was left of it counts for so long.
constexpr double least_improving = 0.1;
constexpr std::chrono::milliseconds longest_carried{200};
/// Instants further apart have nothing to say to each other.
constexpr double longest_gap_s = 1;

constexpr std::uint64_t no_pulse = ~std::uint64_t{0};

/// Something else is wished for.
struct GaveWay {};

std::optional<TaiTime> exposure_of(const FrameSet& set) {
    std::optional<TaiTime> exposure;
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame && (!exposure || slot.frame->exposure < *exposure))
            exposure = slot.frame->exposure;
    return exposure;
}

/// Whether what was prepared for `before` would be another instant, or a better one, for `wish`.
bool is_better(const InstantRequest& request, const InstantRequest& before) {
    const auto is_elsewhere = [](const VirtualView& view, const VirtualView& other) {
        return !view.world_from_camera.isApprox(other.world_from_camera, 1e-6);
    };
    return request.level.rank < before.level.rank || is_elsewhere(request.target, before.target) ||
           (request.preview && (!before.preview || is_elsewhere(*request.preview, *before.preview)));
}

/// Those of the first set. Where others of so many rigs are yet to come, one that is there stands
/// for them too, a little further on each: shaders differ by the number of rigs that are compared,
/// and what rigs do for each other is rehearsed before the show, not in it.
std::vector<DepthView> for_warm_up(std::vector<DepthView> views, std::size_t rigs) {
    // Further apart than a rig's own two cameras, so that others tell something new.
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

/// The first, and what rigs the second has besides.
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

StageFeed kept(StageFeed feed, ReplayBuffer& replay, std::size_t bytes) {
    return bytes > 0 ? kept_feed(std::move(feed), replay) : feed;
}

}  // namespace

InstantThread::InstantThread(Settings settings, StageFeed feed, ContextGroup& contexts)
    : settings_(std::move(settings)),
      contexts_(&contexts),
      replay_(settings_.replay_bytes),
      sets_(kept(std::move(feed), replay_, settings_.replay_bytes)),
      thread_([this] { run(); }) {}

InstantThread::~InstantThread() {
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = true;
    }
    woken_.notify_all();
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

std::future<Background> InstantThread::background() {
    const std::lock_guard lock(mutex_);
    return asked_for_background_.emplace_back().get_future();
}

std::shared_ptr<const ReadyInstant> InstantThread::newest() const {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    return newest_;
}

InstantThread::Stats InstantThread::stats() const {
    const std::lock_guard lock(mutex_);
    Stats stats = stats_;
    stats.superseded = sets_.superseded();
    stats.superseded.sets += failed_.sets;
    for (const auto& [rig, frames] : failed_.frames) stats.superseded.frames[rig] += frames;
    stats.prepare_ms = prepare_ms_.summary();
    stats.rig_steps = {capture_ms_.summary(), rectify_ms_.summary(), match_ms_.summary(),
                       pack_ms_.summary()};
    return stats;
}

ReceiverStatus InstantThread::close() {
    ReceiverStatus status = sets_.close();
    // The look under way may have taken a set before that; the second one after it has none left.
    std::unique_lock lock(mutex_);
    const std::uint64_t before = looks_;
    looked_.wait_for(lock, longest_preparation,
                     [&] { return is_stopping_ || looks_ >= before + 2; });
    return status;
}

void InstantThread::run() {
    name_this_thread("instants");
    std::uint64_t lost = 0;  ///< generation of contexts; 0: none
    for (;;) {
        try {
            contexts_->renew(lost);
            prepare_instants();
            return;
        } catch (const ContextLost& error) {
            log_warning("what was prepared is made anew on new contexts: {}", error.what());
            if (!generations_.empty()) lost = generations_.back().member.generation;
        } catch (const std::exception& error) {
            log_error("an instant could not be prepared, and its preparer is made anew: {}",
                      error.what());
        }
        std::unique_lock lock(mutex_);
        ++stats_.faults;
        count_unprepared();
        if (woken_.wait_for(lock, recovery, [&] { return is_stopping_; })) return;
    }
}

std::optional<FrameSet> InstantThread::next_set(const InstantRequest& request, std::uint64_t shown_pulse,
                                                double& share) {
    const DriverLock::Pause pause;
    share = 0;
    if (!request.pulse && !request.is_held) {
        fetched_.reset();
        try {
            return sets_.take(patience);
        } catch (...) {
            const std::lock_guard lock(mutex_);
            failure_ = std::current_exception();
            is_stopping_ = true;
            return std::nullopt;
        }
    }
    // Once only: what is shown stays, though the buffer drops its set meanwhile.
    if (request.pulse && request.pulse != fetched_) {
        fetched_ = request.pulse;
        if (std::optional<FrameSet> set = past_frame_set(request, shown_pulse, share)) return set;
    }
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, patience, [&] { return is_stopping_; });
    return std::nullopt;
}

std::optional<FrameSet> InstantThread::past_frame_set(const InstantRequest& request, std::uint64_t shown_pulse,
                                                double& share) {
    const std::optional<std::uint64_t> there = past().pulse_at(*request.pulse);
    if (!there) return std::nullopt;
    const double passed = *request.pulse - static_cast<double>(*there);
    const double moment = 1.0 / request.moments_a_pulse;
    // A pulse that the past lacks is not made up for: then the one before it is shown. What was
    // filmed comes before what is made.
    if (request.moments_a_pulse > 1 && passed >= moment / 2 && passed < 1) share = passed;
    if (*there == shown_pulse &&
        (request.moments_a_pulse == 1 || std::abs(share - last_.share) < 0.999 * moment)) {
        share = 0;
        return std::nullopt;
    }
    return share > 0 ? between_.at(past(), *there, share) : past().at(*request.pulse);
}

std::vector<DepthView> InstantThread::views_of(const FrameSet& set, bool is_counted) {
    const DriverLock::Pause pause;
    std::vector<DepthView> views = depth_views_of(set, settings_.colours);
    if (!settings_.compensate_gains) return views;
    if (is_counted) {
        const double pulses = last_compensated_ && set.trigger_index > *last_compensated_
                                  ? static_cast<double>(set.trigger_index - *last_compensated_)
                                  : 0;
        gain_compensation_.see(views, pulses / settings_.pulse_rate_hz);
        last_compensated_ = set.trigger_index;
    }
    for (DepthView& view : views) gain_compensation_.apply(view);
    return views;
}

void InstantThread::ask_for_rigs(std::span<const DepthView> views, const InstantRequest& request) {
    demand_.see(views);
    if (request.target.width_px == 0) return;
    std::vector<VirtualView> targets{request.target};
    if (request.preview) targets.push_back(*request.preview);
    for (const RigDemand::Change& change : demand_.update(targets, MonotonicClock::now())) {
        log_info("asking rig {} to {} sending", change.rig, change.streaming ? "start" : "stop");
        sets_.ask(change.rig, change.streaming);
    }
}

void InstantThread::publish(ReadyInstant ready, const InstantRequest& request,
                            const std::shared_ptr<InstantPreparer>& preparer, MonotonicTime start) {
    ready.instant = preparer->prepare(request.target, request.level);
    if (request.preview && request.level.rank == 0)
        ready.instant = joined(ready.instant, *preparer->prepare(*request.preview, request.level));
    ready.preparer = preparer;
    ready.generation = generations_.back().member.generation;
    Fence::insert().wait("an instant was waited for");
    check_gl("preparing an instant");
    ready.prepare_ms = ms_since(start);
    ++ready.number;
    last_ = std::move(ready);
    const std::lock_guard lock(mutex_);
    newest_ = std::make_shared<const ReadyInstant>(last_);
}

void InstantThread::tend_background(InstantPreparer* preparer) {
    bool learns_anew = false;
    std::vector<std::promise<Background>> asked;
    {
        const std::lock_guard lock(mutex_);
        learns_anew = std::exchange(learns_anew_, false);
        asked = std::exchange(asked_for_background_, {});
    }
    BackgroundAccess* memory = preparer ? preparer->background_access() : nullptr;
    if (learns_anew) {
        // Also not after a reset of the GPU, nor for another synthesiser.
        settings_.set = nullptr;
        for (const auto& [synthesiser, each] : generations_.back().preparers)
            if (BackgroundAccess* one = each->background_access()) one->learn_anew();
    }
    for (std::promise<Background>& one : asked) {
        try {
            if (preparer && !memory)
                fail("the synthesiser {} learns no set: choose another (--synth, F2)",
                     last_.synthesiser);
            Background set = memory ? memory->learnt() : Background();
            if (set.rigs.empty()) fail("nothing is known of the set: no rig has shown any yet");
            one.set_value(std::move(set));
        } catch (const ContextLost&) {
            one.set_exception(std::make_exception_ptr(
                Error("the GPU was reset while the set was read from it; save it again")));
            throw;
        } catch (...) {
            one.set_exception(std::current_exception());
        }
    }
}

void InstantThread::let_go_of_preparers() {
    const auto let_go = [](Generation& one) {
        std::erase_if(one.retired, [](const auto& each) { return each.use_count() == 1; });
    };
    let_go(generations_.back());
    if (generations_.size() == 1) return;
    const CurrentContext none{CurrentContext::None{}};
    for (auto one = generations_.begin(); one != generations_.end() - 1; ++one) {
        for (auto& [synthesiser, preparer] : std::exchange(one->preparers, {}))
            one->retired.push_back(std::move(preparer));
        let_go(*one);
    }
    std::erase_if(generations_, [&](const Generation& one) {
        return one.retired.empty() && &one != &generations_.back();
    });
}

std::shared_ptr<InstantPreparer> InstantThread::preparer_of(const Maker& maker,
                                                            const ShaderLibrary& shaders) {
    auto& known = generations_.back().preparers;
    if (const auto at = known.find(maker.synthesiser); at != known.end()) return at->second;
    std::shared_ptr<InstantPreparer> preparer = maker.make(shaders);
    if (BackgroundAccess* memory = preparer->background_access()) memory->begin_with(settings_.set);
    return known[maker.synthesiser] = std::move(preparer);
}

void InstantThread::give_way_to_jump() const {
    if (!jumps_) return;
    const std::lock_guard lock(mutex_);
    if (request_.jumps != *jumps_) throw GaveWay();
}

bool InstantThread::unless_time_jumps(const InstantRequest& request, const std::function<void()>& work) {
    bool is_done = true;
    jumps_ = request.jumps;
    try {
        work();
    } catch (const GaveWay&) {
        is_done = false;
    } catch (...) {
        // Of what is made anew after a fault nothing gives way.
        jumps_.reset();
        throw;
    }
    jumps_.reset();
    return is_done;
}

void InstantThread::count_unprepared() {
    if (!unprepared_) return;
    ++failed_.sets;
    count_frames(*unprepared_, failed_.frames);
    unprepared_.reset();
}

void InstantThread::note_prepared(bool is_counted, const BackgroundAccess* memory) {
    const std::lock_guard lock(mutex_);
    if (last_.share > 0) ++stats_.between;
    if (is_counted) {
        ++stats_.prepared;
        count_frames(*last_.set, stats_.frames);
        for (const FrameSet::Slot& slot : last_.set->slots) {
            if (!slot.frame) continue;
            capture_ms_.add(slot.frame->times.capture_ms);
            rectify_ms_.add(slot.frame->times.rectify_ms);
            match_ms_.add(slot.frame->times.match_ms);
            pack_ms_.add(slot.frame->times.pack_ms);
        }
    }
    stats_.gain_compensation = gain_compensation_.rigs();
    stats_.sets = memory ? memory->states() : std::vector<RigBackgroundState>();
    prepare_ms_.add(last_.prepare_ms);
}

void InstantThread::warm_up(InstantPreparer& preparer, FrameSet& set, const InstantRequest& request) {
    unprepared_ = set;
    preparer.warm_up(for_warm_up(views_of(set, false), set.slots.size()), request.target);
    is_warmed_up_ = true;
    std::optional<FrameSet> newer = request.pulse ? std::nullopt : sets_.take();
    if (newer) {
        const std::lock_guard lock(mutex_);
        count_unprepared();
        set = std::move(*newer);
    }
    unprepared_.reset();
}

void InstantThread::prepare_instants() {
    if (generations_.empty() || generations_.back().member.generation != contexts_->generation())
        generations_.push_back({contexts_->join(), {}, {}});
    else if (auto faulty = generations_.back().preparers.extract(last_.synthesiser))
        generations_.back().retired.push_back(std::move(faulty.mapped()));
    const ContextGroup::Member member = generations_.back().member;
    const DriverLock turn(contexts_->driver());
    const CurrentContext current(*member.context);
    require_context("instants were prepared");
    const SlicedDrawing slices(
        slice, &way_, [this] { give_way_to_jump(); }, least_preparing);
    const ShaderLibrary shaders;
    std::shared_ptr<InstantPreparer> preparer;
    std::optional<InstantRequest> prepared;  ///< what the newest instant was prepared for
    MonotonicTime refined{};
    TimeBudget improving(least_improving, longest_carried, MonotonicClock::now());
    const auto improve = [&](const InstantRequest& request) {
        const MonotonicTime start = MonotonicClock::now();
        (void)unless_time_jumps(request, [&] { preparer->improve_a_step(request.target); });
        improving.spend(MonotonicClock::now() - start);
    };
    for (;;) {
        InstantRequest request;
        Maker maker;
        {
            const std::lock_guard lock(mutex_);
            if (is_stopping_) break;
            ++looks_;
            looked_.notify_all();
            request = request_;
            maker = maker_;
        }
        if (contexts_->generation() != member.generation)
            throw ContextLost("another thread found the GPU reset");
        let_go_of_preparers();
        tend_background(preparer.get());
        if (maker.make && (!preparer || last_.synthesiser != maker.synthesiser)) {
            preparer = preparer_of(maker, shaders);
            last_.synthesiser = maker.synthesiser;
            last_pulse_.reset();
            prepared.reset();
            // Once: where that fails the next set has to do.
            if (last_.set && !std::exchange(is_retaking_, true)) {
                const MonotonicTime start = MonotonicClock::now();
                preparer->cut();
                preparer->take(views_of(*last_.set, false), 0);
                publish(last_, request, preparer, start);
                prepared = request;
            }
            is_retaking_ = false;
        }
        if (!preparer) {
            const DriverLock::Pause pause;
            std::unique_lock lock(mutex_);
            woken_.wait_for(lock, patience, [&] { return is_stopping_; });
            continue;
        }
        // Of a set that was given up half-way the preparer has some: what is shown comes anew too.
        const std::uint64_t shown = prepared && last_.set ? last_.set->trigger_index : no_pulse;
        MonotonicTime taken_up = MonotonicClock::now();
        double share = 0;
        std::optional<FrameSet> set = next_set(request, shown, share);
        if (set && !is_warmed_up_) {
            warm_up(*preparer, *set, request);
            taken_up = MonotonicClock::now();
        }
        const MonotonicTime start = MonotonicClock::now();
        if (set) {
            const bool is_live = !request.pulse;
            // Of a take everything counts; of a stage's past it was counted when it was live.
            const bool is_counted = share == 0 && (is_live || settings_.take);
            if (is_counted) unprepared_ = *set;
            const double pulse = static_cast<double>(set->trigger_index) + share;
            // Time that runs backwards is no cut.
            const double dt_s = last_pulse_
                                    ? std::abs(pulse - *last_pulse_) / settings_.pulse_rate_hz
                                    : 2 * longest_gap_s;
            if (dt_s > longest_gap_s) preparer->cut();
            last_pulse_ = pulse;
            const std::vector<DepthView> views = views_of(*set, is_counted);
            // In the past the camera says nothing of what is needed live.
            if (is_live) ask_for_rigs(views, request);
            // What was jumped to is made ready in any case, so that a jog shows what it passes.
            const bool is_sought = std::exchange(fetched_jumps_, request.jumps) != request.jumps;
            const auto get_ready = [&] {
                preparer->take(views, std::min(dt_s, longest_gap_s));
                ReadyInstant next = last_;
                next.set = std::make_shared<const FrameSet>(std::move(*set));
                next.share = share;
                next.exposure = exposure_of(*next.set);
                next.is_live = is_live;
                next.taken_up = taken_up;
                next.fetch_ms = to_ms(start - taken_up);
                publish(std::move(next), request, preparer, start);
            };
            if (is_sought)
                get_ready();
            else if (!unless_time_jumps(request, get_ready)) {
                const std::lock_guard lock(mutex_);
                count_unprepared();
                prepared.reset();
                continue;
            }
            prepared = request;
            unprepared_.reset();
            note_prepared(is_counted, preparer->background_access());
            if (is_live && improving.has_some(MonotonicClock::now())) improve(request);
        } else if (prepared && (request.pulse || request.is_held) && is_better(request, *prepared) &&
                   start - refined > refinements) {
            if (unless_time_jumps(request, [&] { publish(last_, request, preparer, start); }))
                prepared = request;
            refined = start;
        } else if (prepared && !request.pulse && !request.is_held) {
            improve(request);
        }
    }
    // What is left of them goes with its preparer, on this context, or on none if that was lost.
    {
        const std::lock_guard lock(mutex_);
        newest_.reset();
    }
    last_ = {};
    preparer.reset();
    generations_.back().preparers.clear();
    generations_.back().retired.clear();
    const CurrentContext none{CurrentContext::None{}};
    generations_.clear();
}

}  // namespace vantage
