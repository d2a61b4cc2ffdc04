#include "host_app/takes/take_control.h"

#include <algorithm>
#include <utility>

#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/output_path.h"
#include "common/base/log.h"
#include "host_app/takes/take_show.h"

namespace vantage {
namespace {

constexpr std::size_t most_attached_bytes = 1 << 20;

std::vector<TakeAttachment> attachments_of(const StageConfig& stage,
                                           const std::filesystem::path& stage_file) {
    std::vector<TakeAttachment> files;
    files.push_back(
        {stage_attachment, "application/toml", read_file(stage_file, most_attached_bytes)});
    for (const StageConfig::Rig& rig : stage.rigs)
        if (!rig.colour.empty())
            files.push_back({rig.name + ".colour.toml", "application/toml",
                             read_file(rig.colour, most_attached_bytes)});
    return files;
}

TakeRecorder::Settings recorder_settings(const StageConfig& stage,
                                         const std::filesystem::path& stage_file,
                                         std::chrono::nanoseconds pre_roll, bool has_sound) {
    TakeRecorder::Settings settings;
    for (const StageConfig::Rig& rig : stage.rigs) settings.rigs.push_back(rig.name);
    settings.attachments = attachments_of(stage, stage_file);
    settings.pulse_rate_hz = stage.rate_hz;
    settings.program = fmt::format("vantage {}", version());
    settings.show = to_json(take_show_of(stage));
    settings.pre_roll = pre_roll;
    settings.has_sound = has_sound;
    return settings;
}

class CameraSink final : public PictureSink {
  public:
    explicit CameraSink(TakeRecorder& recorder) : recorder_(recorder) {}
    std::string name() const override { return ""; }
    void take(const ProgrammePicture& picture) override {
        CameraRecord record;
        record.tick = picture.tick;
        record.pulse = picture.set ? picture.set->trigger_index : 0;
        record.time = TaiClock::now();
        record.world_from_camera = picture.camera.world_from_camera;
        record.field_of_view_rad = picture.camera.field_of_view_rad;
        record.focus_m = picture.camera.focus_m;
        recorder_.offer(record);
    }

  private:
    TakeRecorder& recorder_;
};

}  // namespace

TakeControl::TakeControl(const StageConfig& stage, const std::filesystem::path& stage_file,
                         std::filesystem::path path, std::filesystem::path folder,
                         std::chrono::nanoseconds pre_roll, bool has_sound)
    : path_(std::move(path)),
      folder_(std::move(folder)),
      has_pre_roll_(pre_roll.count() > 0),
      has_sound_(has_sound),
      recorder_(recorder_settings(stage, stage_file, pre_roll, has_sound)) {
    if (!folder_.empty() && !std::filesystem::is_directory(folder_))
        fail("the folder {} for takes does not exist: create it", folder_.string());
}

FrameTap TakeControl::tap() {
    return [this](const ArrivedFrame& frame) { recorder_.offer(frame); };
}

std::function<void(const SoundBlock&)> TakeControl::sound_tap() {
    if (!has_sound_) return {};
    return [this](const SoundBlock& sound) { recorder_.offer(sound); };
}

StageFeed TakeControl::feed(StageFeed feed) {
    if (!feed.ask) return feed;
    ask_ = feed.ask;
    look_at_ = feed.look_at;
    for (const RigStatus& rig : feed.status().rigs) requests_[rig.rig] = true;
    feed.ask = [this](const std::string& rig, bool streaming) {
        const std::lock_guard lock(mutex_);
        requests_[rig] = streaming;
        ask_(rig, streaming || wants_all());
        if (look_at_) look_at_(rig, streaming);
    };
    return feed;
}

std::unique_ptr<PictureSink> TakeControl::camera_sink() {
    return std::make_unique<CameraSink>(recorder_);
}

void TakeControl::ask_all() {
    const std::lock_guard lock(mutex_);
    const bool all = wants_all();
    for (const auto& [rig, streaming] : requests_) ask_(rig, streaming || all);
}

void TakeControl::change_stage(const StageConfig& stage, const std::filesystem::path& stage_file,
                               std::vector<std::string> rigs) {
    TakeRecorder::Stage changed{
        std::move(rigs), {}, to_json(take_show_of(stage)), attachments_of(stage, stage_file)};
    const auto in_stage = [&](const std::string& name) {
        return std::any_of(stage.rigs.begin(), stage.rigs.end(),
                           [&](const StageConfig::Rig& rig) { return rig.name == name; });
    };
    for (const StageConfig::Rig& rig : stage.rigs)
        changed.recorded.push_back(static_cast<std::size_t>(
            std::find(changed.rigs.begin(), changed.rigs.end(), rig.name) - changed.rigs.begin()));
    recorder_.change_stage(std::move(changed));
    const std::lock_guard lock(mutex_);
    // A rig that is added again sends from the start.
    std::erase_if(requests_, [&](const auto& request) { return !in_stage(request.first); });
    for (const StageConfig::Rig& rig : stage.rigs) requests_.try_emplace(rig.name, true);
}

void TakeControl::begin(const std::filesystem::path& path) {
    recorder_.begin(path);
    ask_all();
}

void TakeControl::toggle() {
    try {
        if (!recorder_.is_running()) {
            begin(free_path(path_.empty() ? folder_ / name_for_now("take", ".mkv") : path_));
            return;
        }
        recorder_.end();
        ask_all();
    } catch (const Error& error) {
        log_error("{}", error.what());
    }
}

}  // namespace vantage
