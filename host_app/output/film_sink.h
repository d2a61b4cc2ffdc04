#pragma once

#include <filesystem>

#include "host_app/output/picture_sink.h"
#include "host_app/output/video_recorder.h"

namespace vantage {

/// A film of the programme at its constant rate, on a thread of its own.
class FilmSink final : public PictureSink {
  public:
    /// Throws Error as VideoRecorder does.
    FilmSink(const std::filesystem::path& path, const VideoSettings& settings)
        : path_(path), rate_hz_(settings.rate_hz), recorder_(path, settings) {}

    std::string name() const override { return "film " + path_.string(); }
    void take(const ProgrammePicture& picture) override;
    void finish() override { recorder_.finish(); }

    const std::filesystem::path& path() const { return path_; }
    const VideoRecorder& recorder() const { return recorder_; }

  private:
    std::filesystem::path path_;
    double rate_hz_;
    VideoRecorder recorder_;
};

}  // namespace vantage
