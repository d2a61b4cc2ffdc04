#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "common/image/picture_pool.h"
#include "host_app/programme/picture_maker.h"

namespace vantage {

/// Carries rendered pictures on to newer cameras (Reprojection), one at a time, on a thread of its
/// own, so that the programme's clock waits for none.
class Reprojector {
  public:
    /// Of pictures of this size, or of smaller ones, which are enlarged to it.
    explicit Reprojector(cv::Size size);
    ~Reprojector();
    Reprojector(const Reprojector&) = delete;
    Reprojector& operator=(const Reprojector&) = delete;

    bool is_idle() const;
    /// To the camera of this look. Precondition: is_idle().
    void start(std::shared_ptr<const MadePicture> rendered, const CameraState& camera,
               std::uint64_t look);
    /// Null if none was finished since the last call; those whose way was too long never are.
    std::shared_ptr<const MadePicture> take_finished();
    /// That the last ones took from start() on.
    double longest_ms() const;

  private:
    struct Work {
        std::shared_ptr<const MadePicture> rendered;
        CameraState camera;
        std::uint64_t look;
        MonotonicTime started;
    };
    void run();
    std::shared_ptr<const MadePicture> carried_on(const Work& work);

    cv::Size size_;
    PicturePool pictures_;  ///< of the thread
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    std::optional<Work> work_;
    std::shared_ptr<const MadePicture> finished_;
    double longest_ms_ = 0;
    bool is_stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
