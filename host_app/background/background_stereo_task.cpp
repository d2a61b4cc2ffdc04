#include "host_app/background/background_stereo_task.h"

#include <utility>

#include "common/base/this_thread.h"
#include "common/base/trace/trace.h"

namespace vantage {

void BackgroundStereoTask::begin(std::vector<BackgroundView> views, MatchedSize size,
                                 Manner manner) {
    auto match = [views = std::move(views), size, stop = stop_.get_token()] {
        return match_backgrounds(views, size, stop);
    };
    if (manner == Manner::when_waited_for)
        result_ = std::async(std::launch::deferred, std::move(match));
    else
        result_ = std::async(std::launch::async, [match = std::move(match), size] {
            name_this_thread("bg stereo");
            // Beside a show that takes all processors, an idle thread would need half a minute for
            // the second that half the size takes.
            if (size == MatchedSize::whole) make_this_thread_idle();
            const TraceSpan span("background stereo");
            return match();
        });
}

std::optional<std::vector<DepthImage>> BackgroundStereoTask::take(bool waits) {
    if (!result_.valid()) return std::nullopt;
    if (!waits && result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    return result_.get();
}

}  // namespace vantage
