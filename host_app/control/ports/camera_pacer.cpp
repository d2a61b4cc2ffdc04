#include "host_app/control/ports/camera_pacer.h"

#include <algorithm>
#include <cmath>

#include <pthread.h>

#include "common/base/this_thread.h"

namespace vantage {
namespace {

/// Asks for real-time priority for this thread, below that of drivers. Returns whether it was
/// granted.
bool ask_for_realtime() {
    sched_param parameters{};
    parameters.sched_priority = 10;
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace

CameraPacer::CameraPacer(double rate_hz, std::function<void(const CameraTick&)> send)
    : rate_hz_(rate_hz), send_(std::move(send)) {}

CameraPacer::~CameraPacer() { stop(); }

MonotonicTime CameraPacer::time_of(std::uint64_t tick) const {
    return start_ +
           std::chrono::nanoseconds(std::llround(static_cast<double>(tick) / rate_hz_ * 1e9));
}

void CameraPacer::take(const ProgrammePicture& picture) {
    const MonotonicTime now = MonotonicClock::now();
    const std::lock_guard lock(mutex_);
    if (is_stopped_) return;
    const MonotonicTime start = now - (time_of(picture.tick) - start_);
    start_ = newest_ ? std::min(start_, start) : start;
    if (!newest_) next_ = picture.tick;
    taken_ = now;
    newest_ = CameraTick{picture.tick, picture.camera, picture.set, picture.picture.cols,
                         picture.picture.rows};
    if (picture.tick >= next_ && !is_prompt_) send_newest();
    if (thread_.joinable())
        changed_.notify_one();
    else if (picture.tick > 0)
        thread_ = std::thread([this] { run(); });
}

/// Sends all ticks up to the newest one, which has passed since the last was sent.
void CameraPacer::send_newest() {
    CameraTick tick = *newest_;
    for (; next_ <= newest_->tick; ++next_) {
        tick.tick = next_;
        send_(tick);
    }
}

void CameraPacer::run() {
    name_this_thread("camera pacer");
    constexpr double grace = 0.25;  // periods
    constexpr std::chrono::seconds longest_repetition{1};
    const std::chrono::nanoseconds patience(std::llround(grace / rate_hz_ * 1e9));
    const bool is_prompt = ask_for_realtime();
    std::unique_lock lock(mutex_);
    is_prompt_ = is_prompt;
    while (!is_stopped_) {
        if (newest_->tick >= next_) {
            send_newest();
        } else if (time_of(next_) - taken_ > longest_repetition) {
            changed_.wait(lock);
        } else if (MonotonicClock::now() < time_of(next_) + patience) {
            changed_.wait_until(lock, time_of(next_) + patience);
        } else {
            newest_->tick = next_;
            send_newest();
        }
    }
}

void CameraPacer::stop() {
    {
        const std::lock_guard lock(mutex_);
        if (!is_stopped_ && newest_) send_newest();
        is_stopped_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
}

}  // namespace vantage
