#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/config/stage_config.h"
#include "common/take/take_recorder.h"
#include "host_app/frames/stage_feed.h"
#include "host_app/output/picture_sink.h"

namespace vantage {

/// Begins and ends the takes of a live session. During a take, and always with a pre-roll, every
/// rig is asked for its frames, including those that the programme does not need. Thread-safe.
class TakeControl {
  public:
    /// `stage_file` and the rigs' colour files are attached to every take. Without a `path`, takes
    /// are named by their time and go to `folder`, which must exist; with a path, the second take
    /// is PATH-2. Throws Error if the folder does not exist.
    TakeControl(const StageConfig& stage, const std::filesystem::path& stage_file,
                std::filesystem::path path, std::filesystem::path folder,
                std::chrono::nanoseconds pre_roll, bool has_sound = false);

    /// For the receiver. This object must outlive it.
    FrameTap tap();
    /// Wraps a feed so that all rigs send while a take needs them; frames that the programme does
    /// not need are not decoded. This object must outlive it.
    StageFeed feed(StageFeed feed);
    /// Records sound; empty if takes have no sound. This object must outlive it.
    std::function<void(const SoundBlock&)> sound_tap();
    /// Records the camera of every tick. This object must outlive it.
    std::unique_ptr<PictureSink> camera_sink();

    /// Uses a changed stage for takes that begin from now on. `rigs` are the rigs' names by their
    /// numbers (StageReceiver::numbers_after()). Throws Error if a file cannot be read.
    void change_stage(const StageConfig& stage, const std::filesystem::path& stage_file,
                      std::vector<std::string> rigs);

    /// Throws Error like TakeRecorder::begin().
    void begin(const std::filesystem::path& path);
    /// Ends the current take, or begins one; faults go to the log and the state.
    void toggle();
    /// Ends the current take and waits until it is written.
    void finish() { recorder_.finish(); }

    TakeState state() const { return recorder_.state(); }
    TakeRecorder::PreRoll pre_roll() const { return recorder_.pre_roll(); }

  private:
    bool wants_all() const { return has_pre_roll_ || recorder_.is_running(); }
    void ask_all();

    std::filesystem::path path_, folder_;
    bool has_pre_roll_, has_sound_;
    TakeRecorder recorder_;
    std::mutex mutex_;
    std::function<void(const std::string&, bool)> ask_, look_at_;
    std::map<std::string, bool> requests_;  ///< whether the programme needs a rig's frames
};

}  // namespace vantage
