#include "host_app/programme/picture_maker.h"

#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/time/time.h"
#include "common/base/trace/trace.h"
#include "common/gl/context/context_loss.h"
#include "common/gl/context/driver_lock.h"
#include "common/gl/sliced_drawing.h"

namespace vantage {
namespace {

/// Length of a slice, after which other work may use the GPU.
constexpr std::chrono::milliseconds slice{4};
/// Wait after a fault before the renderer is recreated.
constexpr std::chrono::milliseconds recovery{200};

}  // namespace

bool is_same_picture(const PictureJob& a, const PictureJob& b) {
    return a.instant->number == b.instant->number && is_same_view(a.camera, b.camera) &&
           a.level.rank == b.level.rank && a.source_map == b.source_map;
}

PictureMaker::PictureMaker(SynthesiserEntry synthesiser, PictureFormat format,
                           ContextGroup& contexts, RenderPriority& priority, Manner manner)
    : synthesiser_(std::move(synthesiser)),
      format_(format),
      contexts_(&contexts),
      priority_(&priority),
      manner_(manner),
      thread_([this] { run(); }) {}

PictureMaker::~PictureMaker() {
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = true;
    }
    woken_.notify_all();
    thread_.join();
}

bool PictureMaker::is_idle() const {
    const std::lock_guard lock(mutex_);
    return is_ready_ && !job_;
}

void PictureMaker::start(PictureJob job) {
    {
        const std::lock_guard lock(mutex_);
        job_ = std::move(job);
        started_ = MonotonicClock::now();
    }
    woken_.notify_all();
}

void PictureMaker::warm_up(PictureJob job) {
    {
        const std::lock_guard lock(mutex_);
        job_ = std::move(job);
        is_warm_up_ = true;
    }
    woken_.notify_all();
}

void PictureMaker::pause(bool is_paused) {
    {
        const std::lock_guard lock(mutex_);
        if (std::exchange(is_paused_, is_paused) == is_paused) return;
    }
    woken_.notify_all();
}

void PictureMaker::wait_while_paused() {
    std::unique_lock lock(mutex_);
    woken_.wait(lock, [&] { return is_stopping_ || !is_paused_; });
}

std::shared_ptr<const MadePicture> PictureMaker::take_finished() {
    const std::lock_guard lock(mutex_);
    return std::move(finished_);
}

int PictureMaker::faults() const {
    const std::lock_guard lock(mutex_);
    return faults_;
}

void PictureMaker::run() {
    name_this_thread(manner_ == Manner::at_once ? "picture" : "picture, slices");
    std::uint64_t lost = 0;  ///< generation of contexts that was lost; 0: none
    for (;;) {
        ContextGroup::Member member;
        try {
            contexts_->renew(lost);
            member = contexts_->join();
            make_pictures(member);
            return;
        } catch (const ContextLost& error) {
            log_warning("the renderer is recreated on new GPU contexts: {}", error.what());
            lost = member.generation;
        } catch (const std::exception& error) {
            log_error("rendering failed, and the renderer is recreated: {}", error.what());
        }
        std::unique_lock lock(mutex_);
        ++faults_;
        is_ready_ = is_warm_up_ = false;
        job_.reset();
        if (woken_.wait_for(lock, recovery, [&] { return is_stopping_; })) return;
    }
}

void PictureMaker::make_pictures(const ContextGroup::Member& member) {
    const DriverLock turn(contexts_->driver(), manner_ == Manner::at_once
                                                   ? DriverLock::Urgency::urgent
                                                   : DriverLock::Urgency::usual);
    const CurrentContext current(*member.context);
    require_context("a renderer was set up");
    std::optional<SlicedDrawing> slices;
    if (manner_ == Manner::in_slices)
        slices.emplace(slice, priority_, [this] { wait_while_paused(); });
    const ShaderLibrary shaders;
    ViewPainter painter(synthesiser_, format_, shaders);
    {
        const std::lock_guard lock(mutex_);
        is_ready_ = true;
    }
    std::optional<RenderPriority::Claim> claim;
    while (std::optional<Work> work = next_work(member.generation, claim)) {
        std::shared_ptr<MadePicture> picture;
        if (work->is_warm_up) {
            for (const RenderLevel& level : render_levels()) {
                work->job.level = level;
                (void)rendered(painter, work->job);
            }
        } else {
            picture = rendered(painter, work->job);
        }
        claim.reset();
        const std::lock_guard lock(mutex_);
        job_.reset();
        if (!picture) continue;
        picture->make_ms = ms_since(started_);
        finished_ = std::move(picture);
    }
}

std::optional<PictureMaker::Work> PictureMaker::next_work(
    std::uint64_t generation, std::optional<RenderPriority::Claim>& claim) {
    const DriverLock::Pause pause;
    std::unique_lock lock(mutex_);
    for (;;) {
        woken_.wait(lock, [&] { return is_stopping_ || job_; });
        if (is_stopping_) return std::nullopt;
        if (contexts_->generation() != generation)
            throw ContextLost("another thread detected a GPU reset");
        if (job_->instant->generation == generation) {
            // The claim comes before the driver lock, which threads that prepare keep taking.
            if (manner_ == Manner::at_once) claim.emplace(*priority_);
            return Work{*job_, std::exchange(is_warm_up_, false)};
        }
        job_.reset();
    }
}

std::shared_ptr<MadePicture> PictureMaker::rendered(ViewPainter& painter,
                                                    const PictureJob& job) const {
    TraceSpan span("picture");
    span.with("level", job.level.rank)
        .in(TraceId::of_step(job.step), TraceFlow::passes)
        .in(TraceId::of_frame_set(job.instant->set->trigger_index), TraceFlow::passes);
    auto made = std::make_shared<MadePicture>();
    const MonotonicTime start = MonotonicClock::now();
    made->picture = painter.paint(*job.instant->instant, job.camera, job.level,
                                  job.source_map ? &made->sources : nullptr, &made->inverse_depth);
    made->readback_ms = painter.last_readback_ms();
    made->render_ms = ms_since(start) - made->readback_ms;
    made->job = job;
    return made;
}

}  // namespace vantage
