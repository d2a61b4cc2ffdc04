#include "calib_tools/live/live_rigs.h"

#include <algorithm>
#include <cmath>

#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/time/time.h"
#include "common/config/stage_config.h"
#include "common/receive/stage_receiver.h"
#include "common/wire/limits.h"

namespace vantage {
namespace {

constexpr std::chrono::milliseconds look_every(100);
/// Raw pairs are large and must be complete, so that late ones are waited for longer than on air.
constexpr double latency_budget_ms = 2000;

StageConfig stage_of(const LiveOptions& options) {
    StageConfig stage = load_stage_config(options.stage_file);
    std::vector<StageConfig::Rig> chosen;
    std::string known;
    for (const StageConfig::Rig& rig : stage.rigs) known += (known.empty() ? "" : ", ") + rig.name;
    for (const std::string& name : options.rigs) {
        const auto rig = std::find_if(stage.rigs.begin(), stage.rigs.end(),
                                      [&](const auto& each) { return each.name == name; });
        if (rig == stage.rigs.end())
            fail("{} has no rig named {}; it has {}", options.stage_file.string(), name, known);
        chosen.push_back(*rig);
    }
    stage.rigs = std::move(chosen);
    stage.latency_budget_ms = std::max(stage.latency_budget_ms, latency_budget_ms);
    return stage;
}

std::string state_of(const RigStatus& rig) {
    if (const std::string trouble = trouble_of(rig); !trouble.empty())
        return fmt::format("rig {}: {}", rig.rig, trouble);
    return fmt::format("rig {} is connected and sends no pictures: is it triggered?", rig.rig);
}

}  // namespace

bool LiveInstant::is_complete() const {
    return std::all_of(pairs.begin(), pairs.end(),
                       [](const std::optional<RawPair>& pair) { return pair.has_value(); });
}

struct LiveRigs::Impl {
    explicit Impl(const LiveOptions& chosen)
        : options(chosen),
          stage(stage_of(chosen)),
          receiver(stage, StageReceiver::Purpose::calibrate) {
        const double every = std::round(stage.rate_hz / options.pictures_per_second);
        for (const StageConfig::Rig& rig : stage.rigs)
            receiver.ask(
                rig.name, true,
                static_cast<std::uint32_t>(std::clamp(every, 1.0, double{max_rate_divisor})));
    }

    std::string state(const std::vector<bool>& missing) const {
        std::string sentence;
        const ReceiverStatus status = receiver.status();
        for (std::size_t i = 0; i < status.rigs.size(); ++i)
            if (missing[i]) sentence += (sentence.empty() ? "" : "; ") + state_of(status.rigs[i]);
        return sentence;
    }

    StopSignal stop;  // constructed before the receiver's threads start
    const LiveOptions options;
    const StageConfig stage;
    StageReceiver receiver;
};

LiveRigs::LiveRigs(const LiveOptions& options) : impl_(std::make_unique<Impl>(options)) {}

LiveRigs::~LiveRigs() = default;

std::optional<LiveInstant> LiveRigs::next() {
    const MonotonicTime end = MonotonicClock::now() + impl_->options.patience;
    while (!impl_->stop.requested()) {
        const std::optional<FrameSet> set = impl_->receiver.next(look_every);
        if (set && set->present() > 0) {
            LiveInstant instant;
            instant.pulse = set->trigger_index;
            for (const FrameSet::Slot& slot : set->slots) {
                instant.pairs.emplace_back();
                if (slot.frame && slot.frame->content == RigFrame::Content::raw_pair)
                    instant.pairs.back() =
                        RawPair{slot.frame->colour, slot.frame->right, slot.frame->calibration_id};
            }
            return instant;
        }
        if (MonotonicClock::now() > end)
            fail("no picture came for {} s: {}", impl_->options.patience.count(),
                 impl_->state(std::vector<bool>(impl_->stage.rigs.size(), true)));
    }
    return std::nullopt;
}

std::optional<LiveInstant> LiveRigs::next_complete() {
    const MonotonicTime end = MonotonicClock::now() + impl_->options.patience;
    std::vector<bool> missing(impl_->stage.rigs.size(), true);
    while (std::optional<LiveInstant> instant = next()) {
        if (instant->is_complete()) return instant;
        for (std::size_t i = 0; i < missing.size(); ++i) missing[i] = !instant->pairs[i];
        if (MonotonicClock::now() > end)
            fail("for {} s no instant came from every rig: {}", impl_->options.patience.count(),
                 impl_->state(missing));
    }
    return std::nullopt;
}

}  // namespace vantage
