#include "rig_firmware/trigger/pulse_sender.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <future>
#include <mutex>
#include <thread>
#include <tuple>

#include "common/base/error.h"
#include "common/base/this_thread.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "rig_firmware/trigger/inheriting_mutex.h"
#include "rig_firmware/trigger/pulse_line.h"
#include "rig_firmware/trigger/pulse_schedule.h"
#include "rig_firmware/trigger/realtime.h"
#include "rig_firmware/trigger/sensor_timing.h"

namespace vantage {
namespace {

/// Longest single sleep. It bounds the delay until a stop or a changed clock is noticed.
constexpr std::chrono::milliseconds sleep_slice{50};

}  // namespace

struct PulseSender::Impl {
    Impl(const RigConfig::Trigger& trigger, double rate_hz, std::function<void(std::uint64_t)> tell)
        : timing(sensor_timing(trigger, rate_hz)),
          spin(from_us(trigger.spin_us)),
          priority(trigger.realtime_priority),
          line(open_pulse_line(trigger)),
          on_sent(std::move(tell)),
          schedule(PulseGrid(rate_hz), from_us(trigger.late_limit_us)) {}

    /// Returns false if the thread has to stop or the clock was set back before the deadline.
    bool wait_until(TaiTime deadline) const {
        TaiTime now = TaiClock::now();
        const TaiTime begun = now;
        while (deadline - now > spin) {
            if (stopping || now < begun - sleep_slice) return false;
            sleep_until(std::min(deadline - spin, now + std::chrono::nanoseconds(sleep_slice)));
            now = TaiClock::now();
        }
        while (now < deadline && now >= begun - sleep_slice) now = TaiClock::now();
        return !stopping && now >= deadline;
    }

    void run(std::promise<std::vector<std::string>> realtime) {
        name_this_thread("pulses");
        realtime.set_value(become_realtime(priority));
        try {
            send_all();
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
        }
    }

    void send_all() {
        {
            std::unique_lock lock(mutex);
            go.wait(lock, [&] { return stopping || is_started; });
        }
        while (!stopping) {
            const std::uint64_t index = schedule.next(TaiClock::now(), first);
            if (wait_until(schedule.time_of(index))) send_one(index);
        }
    }

    // Between its deadline and its edge a pulse takes no lock.
    void send_one(std::uint64_t index) {
        if (!schedule.send(index, TaiClock::now())) {
            const std::lock_guard lock(mutex);
            show_counts();
            return;
        }
        line->set(true);
        const TaiTime begun = TaiClock::now();
        if (on_sent) on_sent(index);
        const TaiTime end = begun + timing.pulse_width();
        // A pulse that has begun always ends in time, even during a stop.
        const MonotonicTime monotonic_end = MonotonicClock::now() + timing.pulse_width();
        sleep_until(end - spin);
        while (TaiClock::now() < end && MonotonicClock::now() < monotonic_end) {
        }
        line->set(false);
        const TaiTime ended = TaiClock::now();
        const std::lock_guard lock(mutex);
        show_counts();
        shown.last_index = index;
        lateness_us.add(to_us(begun - schedule.time_of(index)));
        width_error_us.add(to_us(ended - end));
    }

    /// Precondition: mutex is held.
    void show_counts() {
        shown.sent = schedule.sent();
        shown.skipped = schedule.skipped();
        shown.clock_steps = schedule.clock_steps();
    }

    const SensorTiming timing;
    const std::chrono::nanoseconds spin;
    const int priority;
    std::unique_ptr<PulseLine> line;
    std::vector<std::string> realtime_report;
    const std::function<void(std::uint64_t)> on_sent;

    PulseSchedule schedule;  ///< used by the sending thread only
    std::atomic<std::uint64_t> first = 0;

    mutable InheritingMutex mutex;  ///< guards the members below
    std::condition_variable_any go;
    bool is_started = false;
    PulseStatus shown;  ///< all of the status but the percentiles
    PercentileRecorder lateness_us, width_error_us;
    std::exception_ptr failure;

    std::atomic<bool> stopping = false;
    std::thread thread;
};

PulseSender::PulseSender(const RigConfig::Trigger& trigger, double rate_hz,
                         std::function<void(std::uint64_t)> on_sent)
    : impl_(std::make_unique<Impl>(trigger, rate_hz, std::move(on_sent))) {
    std::promise<std::vector<std::string>> realtime;
    std::future<std::vector<std::string>> report = realtime.get_future();
    impl_->thread = std::thread(
        [impl = impl_.get(), p = std::move(realtime)]() mutable { impl->run(std::move(p)); });
    impl_->realtime_report = report.get();
}

PulseSender::~PulseSender() { stop(); }

void PulseSender::start(std::uint64_t first) {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->first = first;
        impl_->is_started = true;
    }
    impl_->go.notify_all();
}

bool PulseSender::started() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->is_started;
}

void PulseSender::stop() {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->stopping = true;
    }
    impl_->go.notify_all();
    if (impl_->thread.joinable()) impl_->thread.join();
}

PulseStatus PulseSender::status() const {
    // Percentiles are computed from copies, so that the sending thread never waits for a sort.
    const auto [shown, lateness_us, width_error_us] = [&] {
        const std::lock_guard lock(impl_->mutex);
        return std::tuple(impl_->shown, impl_->lateness_us, impl_->width_error_us);
    }();
    PulseStatus status = shown;
    status.lateness_us = lateness_us.summary();
    status.width_error_us = width_error_us.summary();
    return status;
}

void PulseSender::rethrow_failure() const {
    std::exception_ptr failure;
    {
        const std::lock_guard lock(impl_->mutex);
        failure = impl_->failure;
    }
    if (failure) std::rethrow_exception(failure);
}

std::vector<std::string> PulseSender::report() const {
    std::vector<std::string> lines = {
        fmt::format("pulses of {:.2f} us on {}: {:.2f} us of exposure, {:.2f} us of readout",
                    to_us(impl_->timing.pulse_width()), impl_->line->text(),
                    to_us(impl_->timing.exposure), to_us(impl_->timing.readout))};
    lines.insert(lines.end(), impl_->realtime_report.begin(), impl_->realtime_report.end());
    return lines;
}

}  // namespace vantage
