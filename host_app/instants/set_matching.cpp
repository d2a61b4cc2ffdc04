#include "host_app/instants/set_matching.h"

#include "common/base/this_thread.h"

namespace vantage {
namespace {

constexpr int niceness = 10;

}  // namespace

void SetMatching::begin(std::vector<SetPicture> sets) {
    result_ = std::async(std::launch::async, [sets = std::move(sets), stop = stop_.get_token()] {
        name_this_thread("set matching");
        make_this_thread_nice(niceness);
        return match_sets(sets, stop);
    });
}

std::optional<std::vector<DepthImage>> SetMatching::take(bool waits) {
    if (!result_.valid()) return std::nullopt;
    if (!waits && result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    return result_.get();
}

}  // namespace vantage
