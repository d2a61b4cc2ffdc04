#pragma once

#include <future>
#include <optional>
#include <stop_token>
#include <vector>

#include "host_app/instants/set_matcher.h"

namespace vantage {

/// Matches sets on a thread of its own, which leaves the processor to all others.
class SetMatching {
  public:
    SetMatching() = default;
    /// Gives up what is under way.
    ~SetMatching() { stop_.request_stop(); }
    SetMatching(const SetMatching&) = delete;
    SetMatching& operator=(const SetMatching&) = delete;

    bool is_under_way() const { return result_.valid(); }
    /// Precondition: nothing is under way.
    void begin(std::vector<SetPicture> sets);
    /// What match_sets() made of them, once; empty before it is done. `waits`: until it is.
    std::optional<std::vector<DepthImage>> take(bool waits = false);

  private:
    std::stop_source stop_;
    std::future<std::optional<std::vector<DepthImage>>> result_;
};

}  // namespace vantage
