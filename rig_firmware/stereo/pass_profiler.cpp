#include "rig_firmware/stereo/pass_profiler.h"

#include <algorithm>

namespace vantage {

void PassProfiler::begin_frame() {
    reports_.clear();
    report_of_run_.clear();
}

void PassProfiler::run(std::string_view name, const PassCost& cost,
                       const std::function<void()>& pass) {
    if (!enabled_) {
        pass();
        return;
    }
    auto report =
        std::ranges::find_if(reports_, [&](const PassReport& r) { return r.name == name; });
    if (report == reports_.end())
        report = reports_.insert(reports_.end(), PassReport{.name = std::string(name)});
    ++report->runs;
    report->bytes_moved += cost.bytes_moved;
    report->operations += cost.operations;
    const std::size_t run = report_of_run_.size();
    report_of_run_.push_back(static_cast<std::size_t>(report - reports_.begin()));
    if (timers_.size() <= run) timers_.emplace_back();
    timers_[run].begin();
    pass();
    timers_[run].end();
}

void PassProfiler::end_frame() {
    for (std::size_t run = 0; run < report_of_run_.size(); ++run)
        reports_[report_of_run_[run]].gpu_ms += timers_[run].wait_ms();
}

}  // namespace vantage
