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
#include "common/wire/zmq_helpers.h"
#include "host_app/takes/take_show.h"

namespace vantage {
namespace {

/// Frames requested at a time: the rig reads the next one while one travels.
constexpr std::uint64_t window = 2;

constexpr std::chrono::seconds progress_period{2};
/// The longest wait between two checks of `is_stopped`.
constexpr std::chrono::milliseconds longest_wait{100};

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

std::vector<FetchStats> KeptFetch::run(const StageConfig& stage,
                                       const std::function<bool()>& is_stopped,
                                       const Progress& progress) const {
    for (const std::string& name : rigs)
        if (std::none_of(stage.rigs.begin(), stage.rigs.end(),
                         [&](const StageConfig::Rig& rig) { return rig.name == name; }))
            fail("the stage has no rig named {}", name);
    std::optional<CurveKeys> keys;
    if (!stage.key_file.empty()) keys = load_key_file(stage.key_file);
    const nlohmann::ordered_json show = to_json(take_show_of(stage));
    zmq::context_t context;
    std::vector<std::unique_ptr<RigFetch>> fetches;
    for (const StageConfig::Rig& rig : stage.rigs) {
        if (!rigs.empty() && std::find(rigs.begin(), rigs.end(), rig.name) == rigs.end()) continue;
        FetchedFiles files(folder, rig.name, show);
        std::vector<std::uint64_t> there = files.there();
        if (take) {
            const std::vector<std::uint64_t> in_take = pulses_of_rig(*take, rig.name);
            there.insert(there.end(), in_take.begin(), in_take.end());
            std::sort(there.begin(), there.end());
        }
        fetches.push_back(std::make_unique<RigFetch>(
            context, rig, keys, stage.rate_hz,
            [this, there = std::move(there)](int tai_offset_s) {
                return missing_parts(range(tai_offset_s), there);
            },
            std::move(files), patience));
    }

    const auto stats = [&] {
        std::vector<FetchStats> all;
        for (const auto& fetch : fetches) all.push_back(fetch->stats());
        return all;
    };
    const auto is_done = [](const auto& fetch) { return fetch->stats().is_done; };
    BandwidthBudget budget(bytes_s);
    MonotonicTime next_progress = MonotonicClock::now() + progress_period;
    for (std::size_t turn = 0;
         !std::all_of(fetches.begin(), fetches.end(), is_done) && !is_stopped(); ++turn) {
        const MonotonicTime now = MonotonicClock::now();
        // Round robin: each rig in turn is the first to use the budget.
        for (std::size_t i = 0; i < fetches.size(); ++i)
            fetches[(turn + i) % fetches.size()]->turn(budget, now);
        if (now >= next_progress) {
            next_progress = now + progress_period;
            progress(stats());
        }
        std::vector<zmq::pollitem_t> items;
        for (const auto& fetch : fetches) {
            items.push_back({fetch->link().socket().handle(), 0, ZMQ_POLLIN, 0});
            items.push_back({fetch->link().monitor().handle(), 0, ZMQ_POLLIN, 0});
        }
        const std::chrono::nanoseconds wait = budget.wait(MonotonicClock::now());
        wait_for(items, wait.count() > 0 ? std::min<std::chrono::nanoseconds>(wait, longest_wait)
                                         : longest_wait);
    }
    for (const auto& fetch : fetches) fetch->finish();
    return stats();
}

}  // namespace vantage
