#include "host_app/output/video_recorder.h"

#include "common/base/error.h"

namespace vantage {
namespace {

/// Rides out a stutter of the encoder; at 1280x720 a picture is 3.7 MB.
constexpr std::size_t waiting_pictures = 8;

}  // namespace

VideoRecorder::VideoRecorder(const std::filesystem::path& path, const VideoSettings& settings)
    : writer_(path, settings), queue_(waiting_pictures), thread_([this] { write(); }) {}

VideoRecorder::~VideoRecorder() {
    queue_.close();
    if (thread_.joinable()) thread_.join();
}

void VideoRecorder::add(const ColourImage& picture, std::chrono::nanoseconds time,
                        std::string timecode) {
    if (failed_) std::rethrow_exception(failure_);
    queue_.push({picture, time, std::move(timecode)});
}

void VideoRecorder::finish() {
    queue_.close();
    thread_.join();
    if (failed_) std::rethrow_exception(failure_);
    try {
        writer_.finish();
    } catch (const std::exception& error) {
        std::rethrow_exception(end_after(error));
    }
}

std::exception_ptr VideoRecorder::end_after(const std::exception& error) {
    if (writer_.frames() == 0) return std::make_exception_ptr(Error(error.what()));
    const char* rest = writer_.keep_what_is_written() ? "; what was written until then is kept"
                                                      : "; nothing of it can be read";
    return std::make_exception_ptr(Error(std::string(error.what()) + rest));
}

void VideoRecorder::write() {
    try {
        for (;;) {
            const std::optional<Picture> picture = queue_.pop_for(std::chrono::seconds(1));
            if (!picture) {
                if (queue_.closed() && queue_.size() == 0) return;
                continue;
            }
            const auto start = std::chrono::steady_clock::now();
            writer_.add(picture->image, picture->time, picture->timecode);
            encode_ms_.add(
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                    .count());
        }
    } catch (const std::exception& error) {
        failure_ = end_after(error);
        failed_ = true;
    }
}

}  // namespace vantage
