#pragma once

#include <future>
#include <optional>
#include <stop_token>
#include <vector>

#include "host_app/baked/bake.h"

namespace vantage {

/// Bakes a background on a thread of its own, or on the thread that waits for its result.
class BakeTask {
  public:
    BakeTask() = default;
    /// Abandons a bake that is under way and waits for its thread.
    ~BakeTask() { stop_.request_stop(); }
    BakeTask(const BakeTask&) = delete;
    BakeTask& operator=(const BakeTask&) = delete;

    bool is_under_way() const { return result_.valid(); }
    /// Starts bake_background(): at idle priority on a thread of its own, or, with `is_waited_for`,
    /// on the thread that calls take(true). Precondition: no bake is under way.
    void begin(std::vector<DepthView> views, bool is_waited_for);
    /// Returns the result, once; nothing before it is ready. With `waits`, waits until it is.
    std::optional<BakedBackground> take(bool waits = false);

  private:
    std::stop_source stop_;
    std::future<std::optional<BakedBackground>> result_;
};

}  // namespace vantage
