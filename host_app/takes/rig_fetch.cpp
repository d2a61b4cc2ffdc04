#include "host_app/takes/rig_fetch.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "common/wire/random_id.h"

namespace vantage {
namespace {

/// Frames requested at a time: the rig reads the next one while one travels.
constexpr std::uint64_t window = 2;

}  // namespace

RigFetch::RigFetch(zmq::context_t& context, const StageConfig::Rig& rig,
                   const std::optional<CurveKeys>& host_keys, double rate_hz, Plan plan,
                   FetchedFiles files, std::chrono::nanoseconds patience)
    : link_(context, rig, host_keys),
      rate_hz_(rate_hz),
      plan_(std::move(plan)),
      files_(std::move(files)),
      patience_(patience) {
    stats_.rig = rig.name;
}

void RigFetch::turn(BandwidthBudget& budget, MonotonicTime now) {
    link_.watch(now);
    while (const std::optional<RigLink::Delivery> delivery = link_.receive(now))
        if (!stats_.is_done) take_in(*delivery, budget);
    if (!stats_.is_done) check_link(link_.view(now), now);
    if (request_ && !stats_.is_done) {
        const std::uint64_t most = std::min(window, request_->to_pulse - next_pulse_);
        while (request_->granted < received_ + most && budget.may_spend(now)) {
            ++request_->granted;
            budget.spend(expected_bytes_);
        }
    }
    RigLink::Request request;
    request.streaming = false;
    request.fetch = stats_.is_done ? std::nullopt : request_;
    link_.tick(request, now);
}

void RigFetch::take_in(const RigLink::Delivery& delivery, BandwidthBudget& budget) {
    if (!delivery.kept || !request_ || delivery.message.fetch->id != request_->id) return;
    // Some were lost, or the rig was restarted and begins again.
    if (delivery.message.fetch->sent != received_ + 1) {
        ask_anew();
        return;
    }
    ++received_;
    const double bytes = static_cast<double>(delivery.kept->bytes());
    budget.spend(bytes - expected_bytes_);
    expected_bytes_ = bytes;
    KeptFrame frame;
    try {
        frame = decode_kept_frame(*delivery.kept);
        const std::uint64_t pulse = frame.frame.record.pulse;
        if (frame.rig.name != stats_.rig || received_ > request_->granted || pulse < next_pulse_ ||
            pulse >= request_->to_pulse)
            fail("it is of rig {} and pulse {}, and was not requested", frame.rig.name, pulse);
        if (PulseGrid(frame.pulse_rate_hz).rate_hz() != PulseGrid(rate_hz_).rate_hz())
            fail("it has {:g} pulses per second, but the stage has {:g}", frame.pulse_rate_hz,
                 rate_hz_);
    } catch (const Error& error) {
        end(fmt::format("a recorded frame of rig {} is invalid: {}", stats_.rig, error.what()));
        return;
    }
    files_.add(frame);
    const std::uint64_t pulse = frame.frame.record.pulse;
    stats_.not_kept += pulse - next_pulse_;
    stats_.seen += pulse + 1 - next_pulse_;
    next_pulse_ = pulse + 1;
    ++stats_.frames;
    stats_.bytes += delivery.kept->bytes();
}

void RigFetch::check_link(const RigLink::View& view, MonotonicTime now) {
    if (view.connected) {
        silent_since_.reset();
    } else {
        if (!silent_since_) silent_since_ = now;
        if (now - *silent_since_ > patience_)
            end(!view.refused.empty()
                    ? view.refused
                    : fmt::format("rig {} does not answer; repeat the command when it does, to "
                                  "continue from here",
                                  stats_.rig));
        return;
    }
    if (!parts_) {
        if (view.sync.rate_hz != 0 &&
            PulseGrid(view.sync.rate_hz).rate_hz() != PulseGrid(rate_hz_).rate_hz()) {
            end(
                fmt::format("rig {} has {:g} pulses per second and the stage has {:g}: make "
                            "rate_hz agree",
                            stats_.rig, view.sync.rate_hz, rate_hz_));
            return;
        }
        const std::vector<PulseRange> parts = plan_(view.sync.tai_offset_s);
        std::uint64_t wanted = 0;
        for (const PulseRange& part : parts) wanted += part.pulses();
        stats_.wanted = wanted;
        parts_.emplace(parts.begin(), parts.end());
        next_part();
        return;
    }
    if (!request_ || !view.fetch || view.fetch->id != request_->id) return;
    if (!view.fetch->trouble.empty()) {
        end(view.fetch->trouble);
    } else if (view.fetch->sent != received_) {
        ask_anew();
    } else if (view.fetch->is_over) {
        stats_.not_kept += request_->to_pulse - next_pulse_;
        stats_.seen += request_->to_pulse - next_pulse_;
        parts_->pop_front();
        next_part();
    }
}

void RigFetch::ask_anew() {
    request_ = FetchRequest{random_id(), next_pulse_, parts_->front().to, 0};
    received_ = 0;
    if (next_pulse_ < request_->to_pulse) return;
    parts_->pop_front();
    next_part();
}

void RigFetch::next_part() {
    request_.reset();
    if (parts_->empty()) {
        stats_.is_done = true;
        return;
    }
    next_pulse_ = parts_->front().from;
    ask_anew();
}

void RigFetch::end(std::string trouble) {
    stats_.trouble = std::move(trouble);
    stats_.is_done = true;
}

void RigFetch::finish() {
    files_.finish();
    stats_.files = files_.files();
    stats_.there = files_.there().size();
}

std::vector<PulseRange> missing_parts(PulseRange whole, std::span<const std::uint64_t> there) {
    std::vector<PulseRange> parts;
    std::uint64_t at = whole.from;
    for (const std::uint64_t pulse : there) {
        if (pulse < at) continue;
        if (pulse >= whole.to) break;
        if (pulse > at) parts.push_back({at, pulse});
        at = pulse + 1;
    }
    if (at < whole.to) parts.push_back({at, whole.to});
    return parts;
}

}  // namespace vantage
