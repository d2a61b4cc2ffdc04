#include "host_app/programme/picture_maker.h"

#include "common/base/log.h"
#include "common/gl/sliced_drawing.h"

namespace vantage {
namespace {

constexpr std::chrono::milliseconds slice{4};
/// After a fault, before everything is made anew.
constexpr std::chrono::milliseconds recovery{200};

double ms_since(MonotonicTime start) {
    return std::chrono::duration<double, std::milli>(MonotonicClock::now() - start).count();
}

}  // namespace

PictureMaker::PictureMaker(SynthesiserEntry synthesiser, PictureFormat format,
                           const EglContext& context, RightOfWay& way, Manner manner)
    : synthesiser_(std::move(synthesiser)),
      format_(format),
      context_(&context),
      way_(&way),
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
    }
    woken_.notify_all();
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
    for (;;) {
        try {
            make_pictures();
            return;
        } catch (const std::exception& error) {
            log_error("the picture could not be rendered, and its renderer is made anew: {}",
                      error.what());
        }
        std::unique_lock lock(mutex_);
        ++faults_;
        is_ready_ = false;
        job_.reset();
        if (woken_.wait_for(lock, recovery, [&] { return is_stopping_; })) return;
    }
}

void PictureMaker::make_pictures() {
    const CurrentContext current(*context_);
    std::optional<SlicedDrawing> slices;
    if (manner_ == Manner::in_slices) slices.emplace(slice, way_);
    const ShaderLibrary shaders;
    ViewPainter painter(synthesiser_, format_, shaders);
    std::unique_lock lock(mutex_);
    is_ready_ = true;
    for (;;) {
        woken_.wait(lock, [&] { return is_stopping_ || job_; });
        if (is_stopping_) return;
        const PictureJob job = *job_;
        lock.unlock();
        auto made = std::make_shared<MadePicture>();
        const MonotonicTime start = MonotonicClock::now();
        std::optional<RightOfWay::Claim> claim;
        if (manner_ == Manner::at_once) claim.emplace(*way_);
        made->picture = painter.paint(*job.instant->instant, job.camera, job.level,
                                      job.source_map ? &made->sources : nullptr);
        made->readback_ms = painter.last_readback_ms();
        claim.reset();
        made->render_ms = ms_since(start) - made->readback_ms;
        made->job = job;
        lock.lock();
        // The hand that moved one which nobody took waits for this one.
        if (finished_ && finished_->job.hand && (!job.hand || *finished_->job.hand < *job.hand))
            made->job.hand = finished_->job.hand;
        finished_ = std::move(made);
        job_.reset();
    }
}

}  // namespace vantage
