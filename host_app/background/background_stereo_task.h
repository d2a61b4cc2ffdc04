#pragma once

#include <future>
#include <optional>
#include <stop_token>
#include <vector>

#include "host_app/background/background_stereo.h"

namespace vantage {

/// Matches sets beside other work, or for who waits for them.
class BackgroundStereoTask {
  public:
    enum class Manner {
        beside,           ///< on a thread of its own, which leaves the processor to all others
        when_waited_for,  ///< on the thread that waits for it
    };

    BackgroundStereoTask() = default;
    /// Gives up what is under way.
    ~BackgroundStereoTask() { stop_.request_stop(); }
    BackgroundStereoTask(const BackgroundStereoTask&) = delete;
    BackgroundStereoTask& operator=(const BackgroundStereoTask&) = delete;

    bool is_under_way() const { return result_.valid(); }
    /// Precondition: nothing is under way.
    void begin(std::vector<BackgroundView> sets, Manner manner);
    /// What match_sets() made of them, once; empty before it is done. `waits`: until it is.
    std::optional<std::vector<DepthImage>> take(bool waits = false);

  private:
    std::stop_source stop_;
    std::future<std::optional<std::vector<DepthImage>>> result_;
};

}  // namespace vantage
