#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host_app/output/picture_sink.h"
#include "host_app/output/set_timecode.h"
#include "host_app/output/video_recorder.h"

namespace vantage {

/// A film of the programme at its constant rate, on a thread of its own. It carries the time code
/// of the instant that its first picture shows.
class FilmSink final : public PictureSink {
  public:
    /// Throws Error as VideoRecorder does.
    FilmSink(const std::filesystem::path& path, const VideoSettings& settings,
             double pulse_rate_hz);

    std::string name() const override { return "film " + path_.string(); }
    void take(const ProgrammePicture& picture) override;
    void finish() override { recorder_.finish(); }

    const std::filesystem::path& path() const { return path_; }
    const VideoRecorder& recorder() const { return recorder_; }

  private:
    std::filesystem::path path_;
    double rate_hz_;
    /// Until the film has begun; none at more than 60 Hz, where one number counts several pictures
    /// and a reader, which counts by the film's rate, would be told a wrong time.
    std::optional<SetTimecode> timecode_;
    std::string begins_at_;
    VideoRecorder recorder_;
};

}  // namespace vantage
