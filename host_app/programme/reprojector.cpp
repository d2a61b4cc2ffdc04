#include "host_app/programme/reprojector.h"

#include <algorithm>
#include <utility>

#include "common/base/this_thread.h"
#include "common/base/time/time.h"
#include "common/base/trace/trace.h"
#include "host_app/programme/reprojection.h"

namespace vantage {
namespace {

/// Factor by which the longest time decays with every frame.
constexpr double decay = 0.998;

}  // namespace

Reprojector::Reprojector(cv::Size size) : size_(size), thread_([this] { run(); }) {}

Reprojector::~Reprojector() {
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = true;
    }
    woken_.notify_all();
    thread_.join();
}

bool Reprojector::is_idle() const {
    const std::lock_guard lock(mutex_);
    return !work_;
}

void Reprojector::start(std::shared_ptr<const MadePicture> rendered, const CameraState& camera,
                        std::uint64_t step) {
    {
        const std::lock_guard lock(mutex_);
        work_ = Work{std::move(rendered), camera, step, MonotonicClock::now()};
    }
    woken_.notify_all();
}

std::shared_ptr<const MadePicture> Reprojector::take_finished() {
    const std::lock_guard lock(mutex_);
    return std::move(finished_);
}

double Reprojector::longest_ms() const {
    const std::lock_guard lock(mutex_);
    return longest_ms_;
}

std::shared_ptr<const MadePicture> Reprojector::reprojected(const Work& work) {
    TraceSpan span("reproject");
    span.in(TraceId::of_step(work.step), TraceFlow::passes);
    const MadePicture& rendered = *work.rendered;
    const std::optional<Reprojection> way =
        Reprojection::between(rendered.job.camera, work.camera, rendered.inverse_depth, size_);
    if (!way) return nullptr;
    auto carried = std::make_shared<MadePicture>(rendered);
    carried->job.camera = work.camera;
    carried->job.step = work.step;
    carried->picture = way->apply(rendered.picture, pictures_.take<ColourImage>(size_));
    if (carried->sources) carried->sources->picture = way->apply(rendered.sources->picture);
    carried->rendered = work.rendered;
    return carried;
}

void Reprojector::run() {
    name_this_thread("reprojection");
    std::unique_lock lock(mutex_);
    for (;;) {
        woken_.wait(lock, [&] { return is_stopping_ || work_; });
        if (is_stopping_) return;
        const Work work = *work_;
        lock.unlock();
        std::shared_ptr<const MadePicture> carried = reprojected(work);
        lock.lock();
        longest_ms_ = std::max(ms_since(work.started), decay * longest_ms_);
        finished_ = std::move(carried);
        work_.reset();
    }
}

}  // namespace vantage
