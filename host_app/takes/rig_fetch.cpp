#include "host_app/takes/rig_fetch.h"

#include <algorithm>

#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/timecode.h"
#include "common/take/kept_files.h"
#include "common/take/take_pulses.h"
#include "common/wire/random_id.h"

namespace vantage {
namespace {

/// Frames requested at a time: the rig reads the next one while one travels.
constexpr std::uint64_t window = 2;

}  // namespace

FetchedFiles::FetchedFiles(std::filesystem::path folder, std::string rig,
                           nlohmann::ordered_json show)
    : folder_(std::move(folder)), rig_(std::move(rig)), show_(std::move(show)) {
    for (const KeptFile& file : kept_files(folder_, rig_)) {
        try {
            const std::vector<std::uint64_t> in_file = pulses_of_rig(TakeReader(file.path), rig_);
            there_.insert(there_.end(), in_file.begin(), in_file.end());
        } catch (const Error& error) {
            log_warning("{}: its frames are fetched again", error.what());
        }
    }
    std::sort(there_.begin(), there_.end());
}

FetchedFiles::~FetchedFiles() {
    try {
        finish();
    } catch (const Error& error) {
        log_error("{}", error.what());
    }
}

void FetchedFiles::add(const KeptFrame& frame) {
    if (writer_ && (writer_->facts().rigs.front() != frame.rig ||
                    writer_->facts().pulse_rate_hz != frame.pulse_rate_hz ||
                    frame.frame.record.pulse <= last_pulse_))
        finish();
    if (!writer_) begin(frame);
    if (!writer_->add(0, frame.frame))
        fail("the frame of pulse {} of rig {} does not fit {}", frame.frame.record.pulse, rig_,
             writer_->path().string());
    last_pulse_ = frame.frame.record.pulse;
    writer_->flush_if_due();
}

void FetchedFiles::begin(const KeptFrame& frame) {
    TakeFacts facts;
    facts.pulse_rate_hz = frame.pulse_rate_hz;
    facts.origin = PulseGrid(frame.pulse_rate_hz).time_of(frame.frame.record.pulse);
    facts.program = fmt::format("vantage {}", version());
    facts.tai_offset_s = frame.tai_offset_s;
    facts.timecode = TimecodeClock(frame.pulse_rate_hz).at(facts.origin, frame.tai_offset_s);
    facts.show = show_;
    facts.rigs = {frame.rig};
    const auto utc = std::chrono::floor<std::chrono::seconds>(facts.origin.time_since_epoch()) -
                     std::chrono::seconds(frame.tai_offset_s);
    const std::filesystem::path path =
        free_path(folder_ / kept_file_name(rig_, static_cast<std::time_t>(utc.count())));
    writer_ = std::make_unique<TakeWriter>(path, facts);
    files_.push_back(path);
}

void FetchedFiles::finish() {
    if (!writer_) return;
    writer_->finish();
    writer_.reset();
}

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
