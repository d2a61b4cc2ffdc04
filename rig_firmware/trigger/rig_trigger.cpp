#include "rig_firmware/trigger/rig_trigger.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "rig_firmware/clock/clock_pair.h"
#include "rig_firmware/clock/frame_indexer.h"
#include "rig_firmware/trigger/edge_watcher.h"
#include "rig_firmware/trigger/inheriting_mutex.h"
#include "rig_firmware/trigger/pulse_sender.h"
#include "rig_firmware/trigger/sensor_timing.h"

namespace vantage {
namespace {

/// Common part of both roles: the history of pulses and the frames that they exposed.
class IndexingTrigger : public RigTrigger {
  public:
    explicit IndexingTrigger(const RigConfig& config)
        : timing_(sensor_timing(config.trigger, config.source.rate_hz)),
          grid_(config.source.rate_hz),
          indexer_(grid_, timing_.timestamp_delay) {}

    std::optional<std::uint64_t> index_of(TaiTime stamp) override {
        const std::lock_guard lock(mutex_);
        return indexer_.index_of(stamp);
    }
    void clock_was_set() override {
        const std::lock_guard lock(mutex_);
        indexer_.clock_was_set();
    }
    std::uint64_t pulses() const override {
        const std::lock_guard lock(mutex_);
        return indexer_.pulses();
    }
    std::uint64_t missed() const override {
        const std::lock_guard lock(mutex_);
        return indexer_.missed();
    }
    TaiTime exposure_centre(TaiTime stamp) const override {
        return stamp - timing_.timestamp_delay + timing_.exposure_centre();
    }

  protected:
    void check_announced(std::uint64_t first_pulse) const {
        constexpr std::chrono::hours farthest(1);
        const auto ahead = grid_.time_of(first_pulse) - TaiClock::now();
        if (ahead > farthest)
            fail(
                "the host announced pulse {} as its first, and at this rig's {:g} Hz and by its "
                "clock that is {} hours ahead: see that this computer's clock is set, and give "
                "rate_hz in stage.toml and in [source] of rig.toml the same value",
                first_pulse, grid_.rate_hz(),
                std::chrono::duration_cast<std::chrono::hours>(ahead).count());
    }

    const SensorTiming timing_;
    const PulseGrid grid_;
    mutable InheritingMutex
        mutex_;  ///< also used by the sending thread, which passes pulses to the indexer
    FrameIndexer indexer_;
};

class LeadingTrigger final : public IndexingTrigger {
  public:
    explicit LeadingTrigger(const RigConfig& config)
        : IndexingTrigger(config),
          sender_(config.trigger, config.source.rate_hz, [this](std::uint64_t index) {
              const std::lock_guard lock(mutex_);
              indexer_.sent(index);
          }) {
        if (config.trigger.start == "at_once")
            announce(grid_.index_at_or_before(TaiClock::now()) + 1);
    }

    void announce(std::uint64_t first_pulse) override {
        check_announced(first_pulse);
        if (first_pulse_.exchange(first_pulse) != first_pulse) sender_.start(first_pulse);
    }

    TriggerStatus status() const override {
        const PulseStatus pulses = sender_.status();
        const std::lock_guard lock(mutex_);
        return {.is_armed = true,
                .first_pulse = first_pulse_,
                .pulses = pulses.sent,
                .skipped = pulses.skipped,
                .clock_steps = pulses.clock_steps,
                .stray_edges = 0,
                .unsynchronized = indexer_.unsynchronized(),
                .lateness_us = pulses.lateness_us};
    }
    void rethrow_failure() const override { sender_.rethrow_failure(); }
    std::vector<std::string> report() const override {
        std::vector<std::string> lines = sender_.report();
        if (first_pulse_ == 0)
            lines.emplace_back("armed: pulses begin when the host announces the first one");
        return lines;
    }

  private:
    std::atomic<std::uint64_t> first_pulse_ = 0;
    PulseSender sender_;  ///< the last member, since its thread uses the members above
};

class FollowingTrigger final : public IndexingTrigger {
  public:
    explicit FollowingTrigger(const RigConfig& config)
        : IndexingTrigger(config), watcher_(config.trigger), line_text_(watcher_.line().text()) {
        thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
    }

    void announce(std::uint64_t first_pulse) override {
        check_announced(first_pulse);
        const std::lock_guard lock(mutex_);
        status_.first_pulse = first_pulse;
    }

    TriggerStatus status() const override {
        const std::lock_guard lock(mutex_);
        TriggerStatus status = status_;
        status.is_armed = true;
        status.skipped = indexer_.missing_edges();
        status.stray_edges = indexer_.stray_edges();
        status.unsynchronized = indexer_.unsynchronized();
        status.lateness_us = lateness_us_.summary();
        return status;
    }
    void rethrow_failure() const override {
        const std::lock_guard lock(mutex_);
        if (failure_) std::rethrow_exception(failure_);
    }
    std::vector<std::string> report() const override {
        return {fmt::format("following the pulses on {}", line_text_)};
    }

  private:
    void watch(const std::stop_token& stop) {
        name_this_thread("edges");
        constexpr std::chrono::milliseconds slice(100);
        constexpr std::chrono::seconds silence(3);
        MonotonicTime last = MonotonicClock::now();
        bool is_silent = false;
        try {
            while (!stop.stop_requested()) {
                const std::optional<EdgeWatcher::Edge> edge = watcher_.next(slice);
                if (edge && edge->leading) {
                    take(*edge);
                    last = MonotonicClock::now();
                    if (std::exchange(is_silent, false))
                        log_info("pulses are seen again on {}", line_text_);
                } else if (!is_silent && MonotonicClock::now() - last > silence) {
                    is_silent = true;
                    log_warning(
                        "no pulse seen on {} for {} s: is the wire in place, and does the "
                        "leading rig send?",
                        line_text_, silence.count());
                }
            }
        } catch (...) {
            const std::lock_guard lock(mutex_);
            failure_ = std::current_exception();
        }
    }

    void take(const EdgeWatcher::Edge& edge) {
        const TaiTime time = ClockPair::now().to_tai(edge.time);
        const std::lock_guard lock(mutex_);
        if (!indexer_.seen(time)) return;
        ++status_.pulses;
        const auto off = time - grid_.time_of(grid_.nearest_index(time));
        lateness_us_.add(to_us(off));
    }

    EdgeWatcher watcher_;
    std::string line_text_;
    TriggerStatus status_;
    PercentileRecorder lateness_us_;
    std::exception_ptr failure_;
    std::jthread thread_;
};

}  // namespace

std::unique_ptr<RigTrigger> RigTrigger::make(const RigConfig& config) {
    if (config.trigger.role == "lead") return std::make_unique<LeadingTrigger>(config);
    if (config.trigger.role == "follow") return std::make_unique<FollowingTrigger>(config);
    return nullptr;
}

}  // namespace vantage
