#include "host_app/live/stage_times.h"

namespace vantage {

const char* stage_name(Stage stage) {
    constexpr std::array<const char*, stage_count> names = {
        "capture", "rectify", "match",  "pack",     "network",
        "decode",  "upload",  "render", "readback", "encode"};
    return names[static_cast<std::size_t>(stage)];
}

void StageTimes::add(Stage stage, double ms) {
    recorders_[static_cast<std::size_t>(stage)].add(ms);
}

std::vector<StageTime> StageTimes::summary() const {
    std::vector<StageTime> times;
    for (std::size_t i = 0; i < stage_count; ++i)
        times.push_back({stage_name(static_cast<Stage>(i)), recorders_[i].summary()});
    return times;
}

}  // namespace vantage
