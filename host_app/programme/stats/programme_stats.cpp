#include "host_app/programme/stats/programme_stats.h"

#include <algorithm>
#include <utility>

#include "host_app/programme/reprojection.h"

namespace vantage {

void ProgrammeRecorder::set_level_shares(std::vector<double> render, std::vector<double> prepare) {
    const std::lock_guard lock(mutex_);
    stats_.render_shares = std::move(render);
    stats_.prepare_shares = std::move(prepare);
}

void ProgrammeRecorder::count_replaced_frame() {
    const std::lock_guard lock(mutex_);
    ++stats_.replaced;
}

std::optional<double> ProgrammeRecorder::record_fresh(const MadePicture& made, MonotonicTime now) {
    if (!first_frame_) first_frame_ = now;
    ++stats_.pictures;
    render_ms_.add(made.render_ms);
    readback_ms_.add(made.readback_ms);
    if (last_new_) interval_ms_.add(to_ms(now - *last_new_));
    last_new_ = now;
    const ReadyInstant& instant = *made.job.instant;
    if (!instant.is_live || !instant.exposure || instant.set->trigger_index == latency_pulse_)
        return std::nullopt;
    latency_pulse_ = instant.set->trigger_index;
    const double latency_ms = to_ms(TaiClock::now() - *instant.exposure);
    // No frame is shown long before its exposure: the clocks of rig and host differ.
    constexpr double clocks_differ_ms = -1000;
    if (latency_ms < clocks_differ_ms) return 0;
    latency_ms_.add(latency_ms);
    return std::max(latency_ms, 0.0);
}

std::optional<double> ProgrammeRecorder::record(const HandOver& frame) {
    const std::lock_guard lock(mutex_);
    std::optional<double> latency_ms;
    if (frame.fresh)
        latency_ms = record_fresh(*frame.fresh, frame.now);
    else if (!frame.was_due)
        last_new_.reset();
    if (const MadePicture* carried = frame.reprojected)
        reprojected_way_.add(Reprojection::way(carried->rendered->job.camera, carried->job.camera));
    if (!frame.fresh && frame.was_due) ++(frame.reprojected ? stats_.reprojected : stats_.repeated);
    stats_.faults = frame.faults;
    stats_.ticks += frame.passed_ticks;
    stats_.missed += frame.passed_ticks - 1;
    stats_.repeated += frame.passed_ticks - 1;
    late_ms_.add(to_ms(frame.now - frame.due));
    stats_.duration_s = to_ms(frame.now - *first_frame_) / 1000;
    return latency_ms;
}

void ProgrammeRecorder::record_rest(double ms) {
    const std::lock_guard lock(mutex_);
    rest_ms_.add(ms);
}

void ProgrammeRecorder::record_preview(std::uint64_t pictures, double ms) {
    const std::lock_guard lock(mutex_);
    if (std::exchange(stats_.preview_pictures, pictures) != pictures) preview_ms_.add(ms);
}

std::uint64_t ProgrammeRecorder::ticks() const {
    const std::lock_guard lock(mutex_);
    return stats_.ticks;
}

ProgrammeStats ProgrammeRecorder::stats() const {
    const std::lock_guard lock(mutex_);
    ProgrammeStats stats = stats_;
    stats.late_ms = late_ms_.summary();
    stats.reprojected_way = reprojected_way_.summary();
    stats.interval_ms = interval_ms_.summary();
    stats.latency_ms = latency_ms_.summary();
    stats.rest_ms = rest_ms_.summary();
    stats.preview_ms = preview_ms_.summary();
    stats.render_ms = render_ms_.summary();
    stats.readback_ms = readback_ms_.summary();
    return stats;
}

}  // namespace vantage
