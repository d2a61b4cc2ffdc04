#pragma once

#include <future>
#include <optional>
#include <stop_token>
#include <vector>

#include "host_app/background/background_stereo.h"

namespace vantage {

/// Runs background stereo, on a thread of its own or on the thread that waits for its result.
class BackgroundStereoTask {
  public:
    enum class Manner {
        beside,           ///< on a thread of its own, at idle priority if the whole size is matched
        when_waited_for,  ///< on the thread that calls take(true)
    };

    BackgroundStereoTask() = default;
    /// Abandons a run that is under way and waits for its thread.
    ~BackgroundStereoTask() { stop_.request_stop(); }
    BackgroundStereoTask(const BackgroundStereoTask&) = delete;
    BackgroundStereoTask& operator=(const BackgroundStereoTask&) = delete;

    bool is_under_way() const { return result_.valid(); }
    /// Starts match_backgrounds(). Precondition: no run is under way.
    void begin(std::vector<BackgroundView> views, MatchedSize size, Manner manner);
    /// Returns the result of match_backgrounds(), once; nothing before it is ready. With `waits`,
    /// waits until it is.
    std::optional<std::vector<DepthImage>> take(bool waits = false);

  private:
    std::stop_source stop_;
    std::future<std::optional<std::vector<DepthImage>>> result_;
};

}  // namespace vantage
