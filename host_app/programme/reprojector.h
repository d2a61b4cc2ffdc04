#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "common/image/picture_pool.h"
#include "host_app/programme/picture_maker.h"

namespace vantage {

/// Reprojects rendered frames to newer cameras (see Reprojection), one at a time, on its own
/// thread, so that the programme's clock never waits.
class Reprojector {
  public:
    /// Results have this size; smaller frames are enlarged.
    explicit Reprojector(cv::Size size);
    ~Reprojector();
    Reprojector(const Reprojector&) = delete;
    Reprojector& operator=(const Reprojector&) = delete;

    bool is_idle() const;
    /// Starts to reproject a frame to the camera of a step. Precondition: is_idle().
    void start(std::shared_ptr<const MadePicture> rendered, const CameraState& camera,
               std::uint64_t step);
    /// The reprojection that was finished since the last call. Null if there is none, or if the way
    /// was too long.
    std::shared_ptr<const MadePicture> take_finished();
    /// Longest time from start() to the result, of the last frames.
    double longest_ms() const;

  private:
    struct Work {
        std::shared_ptr<const MadePicture> rendered;
        CameraState camera;
        std::uint64_t step;
        MonotonicTime started;
    };
    void run();
    std::shared_ptr<const MadePicture> reprojected(const Work& work);

    cv::Size size_;
    PicturePool pictures_;  ///< used on the thread only
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    std::optional<Work> work_;
    std::shared_ptr<const MadePicture> finished_;
    double longest_ms_ = 0;
    bool is_stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
