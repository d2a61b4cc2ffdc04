#include "host_app/baked/bake_task.h"

#include <utility>

#include "common/base/this_thread.h"

namespace vantage {

void BakeTask::begin(std::vector<DepthView> views, bool is_waited_for) {
    auto bake = [views = std::move(views), stop = stop_.get_token()] {
        return bake_background(views, stop);
    };
    if (is_waited_for)
        result_ = std::async(std::launch::deferred, std::move(bake));
    else
        result_ = std::async(std::launch::async, [bake = std::move(bake)] {
            name_this_thread("bake");
            make_this_thread_idle();
            return bake();
        });
}

std::optional<BakedBackground> BakeTask::take(bool waits) {
    if (!result_.valid()) return std::nullopt;
    if (!waits && result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    return result_.get();
}

}  // namespace vantage
