#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "common/config/stage_config.h"
#include "common/take/take_recorder.h"
#include "host_app/frames/stage_feed.h"
#include "host_app/output/picture_sink.h"

namespace vantage {

/// Begins and ends a live session's takes. While one runs, and always where takes have a pre-roll,
/// every rig is asked for its frames, also those that the programme does not need now. Thread-safe.
class TakeControl {
  public:
    /// `stage_file` is attached to every take, and the rigs' colour files are. Without a `path`
    /// takes are named for the time at which they begin and go to `folder`, which has to be there;
    /// with one the second is PATH-2. Throws Error without that folder.
    TakeControl(const StageConfig& stage, const std::filesystem::path& stage_file,
             std::filesystem::path path, std::filesystem::path folder,
             std::chrono::nanoseconds pre_roll, bool has_sound = false);

    /// For the receiver; this must outlive it.
    FrameTap tap();
    /// The same feed, whose rigs send while a take wants them; those that the programme does not
    /// need are not decoded then. This must outlive it.
    StageFeed feed(StageFeed feed);
    /// Records what is heard; empty: takes have no sound. This must outlive it.
    std::function<void(const SoundBlock&)> sound_tap();
    /// Records the camera of every tick. This must outlive it.
    std::unique_ptr<PictureSink> camera_sink();

    /// Throws Error as TakeRecorder::begin.
    void begin(const std::filesystem::path& path);
    /// Ends the take that runs, or begins one; what is wrong with that shows in the log and state.
    void toggle();
    /// Ends the take that runs and waits until it is written.
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
    std::map<std::string, bool> requests_;  ///< of the programme: whether it needs a rig's frames
};

}  // namespace vantage
