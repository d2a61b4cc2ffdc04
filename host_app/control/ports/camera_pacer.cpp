#include "host_app/control/ports/camera_pacer.h"

#include <algorithm>
#include <chrono>

#include <poll.h>
#include <pthread.h>

#include "common/base/this_thread.h"

namespace vantage {
namespace {

/// Asks for real-time priority for this thread, below that of drivers.
void ask_for_realtime() {
    sched_param parameters{};
    parameters.sched_priority = 10;
    (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

}  // namespace

CameraTick camera_tick_of(const ProgrammePicture& picture) {
    return {.tick = picture.tick,
            .due = picture.due,
            .camera = picture.camera,
            .width_px = picture.picture.cols,
            .height_px = picture.picture.rows,
            .timecode = {},
            .ptp_locked = {}};
}

CameraPacer::CameraPacer(double rate_hz, std::function<void(const CameraTick&)> send)
    : rate_hz_(rate_hz), send_(std::move(send)), thread_([this] { run(); }) {}

CameraPacer::~CameraPacer() { stop(); }

void CameraPacer::take(const CameraTick& tick) {
    if (is_stopped_) return;
    handed_.give(tick);
    changed_.notify();
}

void CameraPacer::stop() {
    is_stopped_ = true;
    changed_.notify();
    if (thread_.joinable()) thread_.join();
}

/// Sends all ticks up to the newest one, which has passed since the last was sent.
void CameraPacer::send_until(const CameraTick& newest) {
    CameraTick tick = newest;
    for (; next_ <= newest.tick; ++next_) {
        tick.tick = next_;
        tick.due = newest.due - from_s(static_cast<double>(newest.tick - next_) / rate_hz_);
        send_(tick);
    }
}

MonotonicTime CameraPacer::due_of_next(const CameraTick& newest) const {
    return newest.due + from_s(static_cast<double>(next_ - newest.tick) / rate_hz_);
}

void CameraPacer::wait_until(std::optional<MonotonicTime> time) const {
    timespec timeout{};
    if (time) {
        const std::chrono::nanoseconds left =
            std::max(*time - MonotonicClock::now(), std::chrono::nanoseconds(0));
        const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
        timeout = {.tv_sec = seconds.count(), .tv_nsec = (left - seconds).count()};
    }
    pollfd event{.fd = changed_.fd(), .events = POLLIN, .revents = 0};
    (void)ppoll(&event, 1, time ? &timeout : nullptr, nullptr);
}

void CameraPacer::run() {
    name_this_thread("camera pacer");
    ask_for_realtime();
    constexpr double grace = 0.25;  // periods
    constexpr std::chrono::seconds longest_repetition{1};
    const std::chrono::nanoseconds patience = from_s(grace / rate_hz_);
    CameraTick newest;
    bool is_begun = false;
    for (;;) {
        changed_.clear();
        const bool is_last = is_stopped_;
        if (const CameraTick* handed = handed_.take()) {
            newest = *handed;
            is_begun = true;
            send_until(newest);
        }
        if (is_last) return;
        if (!is_begun || due_of_next(newest) - newest.due > longest_repetition) {
            wait_until(std::nullopt);
        } else if (const MonotonicTime latest = due_of_next(newest) + patience;
                   MonotonicClock::now() < latest) {
            wait_until(latest);
        } else {
            CameraTick repeated = newest;
            repeated.tick = next_;
            repeated.due = due_of_next(newest);
            send_until(repeated);
        }
    }
}

}  // namespace vantage
