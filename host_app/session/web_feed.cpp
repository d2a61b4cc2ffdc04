#include "host_app/session/web_feed.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_app/desk/air_verdict.h"
#include "host_app/desk/feed/desk_values.h"
#include "host_app/session/report/rig_words.h"

namespace vantage {
namespace {

constexpr std::chrono::milliseconds web_state_period{250};

const char* key_of(AirVerdict::Level level) {
    switch (level) {
        case AirVerdict::Level::ready:
            return "ready";
        case AirVerdict::Level::caution:
            return "caution";
        case AirVerdict::Level::not_ready:
            break;
    }
    return "not_ready";
}

const char* key_of(Mark mark) {
    return mark == Mark::good ? "good" : mark == Mark::care ? "care" : "bad";
}

std::string take_words(const std::optional<TakeState>& take) {
    if (!take) return "No take.";
    if (!take->failure.empty()) return "The take has failed: " + take->failure;
    return take->phase == TakePhase::recording
               ? fmt::format("A take is recorded: {:.0f} s, {:.0f} MB", take->duration_s,
                             static_cast<double>(take->bytes) / 1e6)
               : fmt::format("The last take has {:.0f} s.", take->duration_s);
}

}  // namespace

WebFeed::WebFeed(const std::string& url, OperatorInputBox& input)
    : server_(url, input), has_control_(OutputUrl::parse(url, "web").option("control") == "yes") {}

void WebFeed::follow(const LiveShow& show, const std::optional<TakeState>& take,
                     const ShowLamps& lamps, MonotonicTime now) {
    const ProgrammeState programme = show.state();
    if (!refreshed_ || now - *refreshed_ >= web_state_period) {
        refreshed_ = now;
        state_ = state_of(show, programme, take, lamps, now);
    }
    WebShown shown{.picture = {}, .set = {}, .state = state_};
    if (programme.picture) {
        shown.picture = programme.picture->picture;
        shown.set = programme.picture->job.instant->set;
    }
    server_.show(std::move(shown));
}

std::string WebFeed::state_of(const LiveShow& show, const ProgrammeState& programme,
                              const std::optional<TakeState>& take, const ShowLamps& lamps,
                              MonotonicTime now) {
    const LiveReport report = show.report();
    const FrameSet* set = programme.picture ? programme.picture->job.instant->set.get() : nullptr;
    ticks_.add(report.programme.ticks, now);
    repeats_.add(report.programme.repeated, now);
    // The part of the desk's values that the verdict is made of.
    DeskState desk;
    desk.waiting = set == nullptr;
    desk.has_frame_sets = show.settings().take || report.frame_sets_closed > 0;
    desk.signal = report.signal;
    desk.age_s = live_age_s(programme);
    if (show.settings().take) desk.time.emplace().is_of_take = true;
    if (report.signal != SignalState::no_signal) desk.coverage = report.corridor.now;
    desk.tick_rate_hz = ticks_.per_second();
    desk.repeat_rate_hz = repeats_.per_second();
    if (take) desk.take.emplace().failure = take->failure;

    nlohmann::ordered_json json;
    json["rigs"] = json["outputs"] = nlohmann::ordered_json::array();
    for (const RigAccount& account : report.rigs) {
        const RigStatus& status = account.status;
        DeskRig rig;
        rig.name = status.rig;
        rig.state = state_in(set, status);
        const auto seen = rigs_seen_.try_emplace(status.rig, now).first;
        if (rig.state == RigState::present) seen->second = now;
        rig.absent_s = std::chrono::duration<double>(now - seen->second).count();
        rig.worries = worries_of(status);
        nlohmann::ordered_json sentences = rig.worries;
        for (const std::string& sentence : {status.refused, status.unreachable})
            if (!sentence.empty()) sentences.push_back(sentence);
        nlohmann::ordered_json shown{
            {"name", rig.name},
            {"state", label_of(rig.state).words},
            {"mark", key_of(label_of(rig.state).mark)},
            {"sentences", sentences},
            {"clock", short_clock_words(status)},
            {"locked", status.same_clock || status.sync.disciplined},
            {"calibration", calibration_words(status.health, std::chrono::system_clock::now())}};
        if (status.health.temperature_c) shown["temperature_c"] = *status.health.temperature_c;
        json["rigs"].push_back(std::move(shown));
        desk.rigs.push_back(std::move(rig));
    }
    for (const OutputState& output : report.outputs) {
        const bool is_failed = output.phase == OutputPhase::failed;
        DeskOutput& shown = desk.outputs.emplace_back();
        shown.name = output.name;
        shown.is_failed = is_failed;
        json["outputs"].push_back(
            {{"name", output.name}, {"state", words_of(output.phase)}, {"failed", is_failed}});
    }
    const AirVerdict verdict = air_verdict(desk);
    json["verdict"] = {{"level", key_of(verdict.level)}, {"why", verdict.why}};
    json["timecode"] = lamps.timecode;
    json["take"] = take_words(take);
    json["control"] = has_control_;
    for (const Lamp& lamp : vantage::lamps())
        std::visit([&](const auto& value) { json["lamps"][lamp.name] = value; }, lamp.of(lamps));
    return json.dump();
}

}  // namespace vantage
