#include "host_app/session/web_feed.h"

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_app/desk/feed/desk_values.h"
#include "host_app/session/report/live_report.h"

namespace vantage {
namespace {

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
    : server_(url, input),
      has_control_(OutputUrl::parse(url, "web").option("control") == "yes"),
      board_(OutputUrl::parse(url, "web").option("board").value_or("")) {}

void WebFeed::follow(const LiveShow& show, const AirWatch::Seen& seen, bool is_new,
                     const std::optional<TakeState>& take, const ShowLamps& lamps) {
    if (is_new) state_ = state_of(seen, take, lamps);
    const ProgrammeState programme = show.state();
    WebShown shown{.picture = {}, .set = {}, .state = state_};
    if (programme.picture) {
        shown.picture = programme.picture->picture;
        shown.set = programme.picture->job.instant->set;
    }
    server_.show(std::move(shown));
}

std::string WebFeed::state_of(const AirWatch::Seen& seen, const std::optional<TakeState>& take,
                              const ShowLamps& lamps) const {
    nlohmann::ordered_json json;
    json["rigs"] = json["outputs"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < seen.rigs.size(); ++i) {
        const DeskRig& rig = seen.rigs[i];
        const RigStatus& status = seen.report.rigs[i].status;
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
    }
    for (const OutputState& output : seen.report.outputs)
        json["outputs"].push_back({{"name", output.name},
                                   {"state", words_of(output.phase)},
                                   {"failed", output.phase == OutputPhase::failed}});
    json["verdict"] = {{"level", key_of(seen.verdict.level)}, {"why", seen.verdict.why}};
    json["timecode"] = lamps.timecode;
    json["take"] = take_words(take);
    json["control"] = has_control_;
    json["board"] = std::filesystem::path(board_).filename().string();
    for (const Lamp& lamp : vantage::lamps())
        std::visit([&](const auto& value) { json["lamps"][lamp.name] = value; }, lamp.of(lamps));
    return json.dump();
}

}  // namespace vantage
