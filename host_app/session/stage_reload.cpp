#include "host_app/session/stage_reload.h"

#include <map>
#include <utility>

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/colour/colour_file.h"
#include "common/config/stage_change.h"
#include "common/wire/curve_keys.h"

namespace vantage {
namespace {

std::string host_key_of(const StageConfig& stage) {
    return stage.key_file.empty() ? "" : load_key_file(stage.key_file).public_key;
}

}  // namespace

StageReload::StageReload(std::filesystem::path file, StageConfig stage, StageReceiver& receiver,
                         TakeControl& takes, LiveShow& show)
    : file_(std::move(file)),
      stage_(std::move(stage)),
      host_key_(host_key_of(stage_)),
      receiver_(receiver),
      takes_(takes),
      show_(show) {}

void StageReload::reload() {
    try {
        reloads_.sentence = fmt::format("stage file reloaded: {}", follow_file());
        reloads_.was_refused = false;
        ++reloads_.done;
        log_info("{}", reloads_.sentence);
    } catch (const Error& error) {
        reloads_.sentence =
            fmt::format("the stage stays as it was, because its file is invalid: {}", error.what());
        reloads_.was_refused = true;
        ++reloads_.refused;
        log_error("{}", reloads_.sentence);
    }
    reloads_.when = MonotonicClock::now();
    show_.note_reload(reloads_);
}

/// Returns what changed. Throws Error before anything has changed.
std::string StageReload::follow_file() {
    const StageConfig file = load_stage_config(file_);
    const StageChange change = stage_change(stage_, file);
    StageConfig stage = stage_to_go_on_with(stage_, file);
    std::map<std::string, ColourCorrection> colours;
    for (const StageConfig::Rig& rig : stage.rigs)
        if (!rig.colour.empty()) colours[rig.name] = load_colour(rig.colour);
    std::string host_key = host_key_of(stage);
    StageReceiver::Update update = receiver_.prepare(stage);
    // Before the receiver, so that a take knows the name of a rig whose first frame comes at once.
    takes_.change_stage(stage, file_, update.names());
    receiver_.follow(std::move(update));
    show_.set_colours(std::move(colours));
    stage_ = std::move(stage);
    return text_of(change, std::exchange(host_key_, std::move(host_key)) != host_key_);
}

}  // namespace vantage
