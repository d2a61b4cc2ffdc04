#include "rig_firmware/trigger/bar_driver.h"

#include <atomic>
#include <exception>
#include <future>
#include <gpiod.hpp>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/this_thread.h"
#include "common/base/time/time.h"
#include "rig_firmware/trigger/inheriting_mutex.h"
#include "rig_firmware/trigger/line_request.h"
#include "rig_firmware/trigger/realtime.h"

namespace vantage {
namespace {

class PretendedBarLines final : public BarLines {
  public:
    void set(std::uint32_t, std::uint32_t) override {}
    std::string text() const override { return "pretended lines (timing only)"; }
};

class GpioBarLines final : public BarLines {
  public:
    GpioBarLines(std::vector<GpioLine> lines, bool active_low)
        : lines_(std::move(lines)),
          request_(request_lines(lines_, gpiod::line_settings()
                                             .set_direction(gpiod::line::direction::OUTPUT)
                                             .set_active_low(active_low)
                                             .set_output_value(gpiod::line::value::INACTIVE))) {
        values_.reserve(lines_.size());
    }

    void set(std::uint32_t lit, std::uint32_t changed) override {
        values_.clear();
        for (std::size_t led = 0; led < lines_.size(); ++led)
            if (changed >> led & 1)
                values_.emplace_back(lines_[led].offset, lit >> led & 1
                                                             ? gpiod::line::value::ACTIVE
                                                             : gpiod::line::value::INACTIVE);
        if (values_.empty()) return;
        try {
            request_.set_values(values_);
        } catch (const std::exception& error) {
            fail("the bar's lines of '{}' cannot be set any more: {}", lines_.front().label,
                 error.what());
        }
    }

    std::string text() const override {
        std::string names;
        for (const GpioLine& line : lines_) names += (names.empty() ? "" : ", ") + line.name;
        return names + " of '" + lines_.front().label + "'";
    }

  private:
    std::vector<GpioLine> lines_;
    gpiod::line_request request_;
    gpiod::line::value_mappings values_;
};

}  // namespace

std::unique_ptr<BarLines> open_bar_lines(const std::string& chip,
                                         const std::vector<std::string>& names, bool active_low) {
    std::vector<GpioLine> lines;
    for (const std::string& name : names) {
        RigConfig::Trigger wanted;
        wanted.chip = chip;
        wanted.line = name;
        lines.push_back(find_gpio_line(wanted));
        for (std::size_t other = 0; other + 1 < lines.size(); ++other)
            if (lines[other].offset == lines.back().offset)
                fail("the line {} is named twice: every LED has a line of its own", name);
    }
    return std::make_unique<GpioBarLines>(std::move(lines), active_low);
}

std::unique_ptr<BarLines> pretend_bar_lines() { return std::make_unique<PretendedBarLines>(); }

struct BarDriver::Impl {
    void run(std::promise<std::vector<std::string>> realtime, int priority) {
        name_this_thread("bar");
        realtime.set_value(become_realtime(priority, "steps"));
        try {
            count();
            lines->set(0, ~0u);
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
        }
    }

    void count() {
        std::uint32_t lit = 0;
        std::int64_t last = TaiClock::now().time_since_epoch() / bar.step();
        while (!stopping) {
            const TaiTime next((last + 1) * bar.step());
            sleep_until(next - spin);
            TaiTime now = TaiClock::now();
            while (now < next && next - now <= spin) now = TaiClock::now();
            const std::int64_t step = now.time_since_epoch() / bar.step();
            if (step == last)
                continue;  // woken early, or the clock was set back by less than a step
            const std::uint32_t wanted = SyncBar::lit_in(bar.step_at(now));
            lines->set(wanted, wanted ^ lit);
            lit = wanted;
            const TaiTime done = TaiClock::now();
            const std::lock_guard lock(mutex);
            ++shown;
            if (step > last) skipped += static_cast<std::uint64_t>(step - last - 1);
            lateness_us.add(to_us(done - TaiTime(step * bar.step())));
            last = step;
        }
    }

    const SyncBar bar;
    const std::unique_ptr<BarLines> lines;
    const std::chrono::nanoseconds spin;
    std::vector<std::string> realtime_report = {};

    mutable InheritingMutex mutex = {};  ///< guards the members below
    std::uint64_t shown = 0, skipped = 0;
    PercentileRecorder lateness_us{1 << 16};
    std::exception_ptr failure = nullptr;

    std::atomic<bool> stopping = false;
    std::thread thread = {};
};

BarDriver::BarDriver(const SyncBar& bar, std::unique_ptr<BarLines> lines,
                     std::chrono::nanoseconds spin, int realtime_priority)
    : impl_(new Impl{.bar = bar, .lines = std::move(lines), .spin = spin}) {
    std::promise<std::vector<std::string>> realtime;
    std::future<std::vector<std::string>> report = realtime.get_future();
    impl_->thread =
        std::thread([impl = impl_.get(), p = std::move(realtime), realtime_priority]() mutable {
            impl->run(std::move(p), realtime_priority);
        });
    impl_->realtime_report = report.get();
}

BarDriver::~BarDriver() { stop(); }

void BarDriver::stop() {
    impl_->stopping = true;
    if (impl_->thread.joinable()) impl_->thread.join();
}

BarStatus BarDriver::status() const {
    // Percentiles are computed from a copy, so that the counting thread never waits for a sort.
    PercentileRecorder lateness_us;
    BarStatus status;
    {
        const std::lock_guard lock(impl_->mutex);
        status.shown = impl_->shown;
        status.skipped = impl_->skipped;
        lateness_us = impl_->lateness_us;
    }
    status.lateness_us = lateness_us.summary();
    return status;
}

void BarDriver::rethrow_failure() const {
    std::exception_ptr failure;
    {
        const std::lock_guard lock(impl_->mutex);
        failure = impl_->failure;
    }
    if (failure) std::rethrow_exception(failure);
}

std::vector<std::string> BarDriver::report() const {
    std::vector<std::string> lines = {fmt::format(
        "{} LEDs count steps of {:g} us, all over again every {:g} ms, on {}", impl_->bar.leds(),
        to_us(impl_->bar.step()), to_us(impl_->bar.period()) / 1e3, impl_->lines->text())};
    lines.insert(lines.end(), impl_->realtime_report.begin(), impl_->realtime_report.end());
    return lines;
}

}  // namespace vantage
