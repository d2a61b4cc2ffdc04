#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "common/base/percentiles.h"
#include "host_app/programme/picture_maker.h"
#include "host_app/programme/picture_sinks.h"
#include "host_app/programme/stats/seek_watch.h"

namespace vantage {

/// Counters and measurements of the programme.
struct ProgrammeStats {
    std::uint64_t ticks = 0;        ///< since the first frame
    std::uint64_t pictures = 0;     ///< ticks with a newly rendered frame
    std::uint64_t reprojected = 0;  ///< ticks whose new frame was not ready, and which got the last
                                    ///< one reprojected to the present camera
    Percentiles reprojected_way;    ///< of all reprojections, as a share of the picture's width
    std::uint64_t repeated = 0;     ///< such ticks that got the last frame as it was
    std::uint64_t missed = 0;    ///< repeated ticks that the programme reached too late; sinks got
                                 ///< their frames late
    std::uint64_t replaced = 0;  ///< frames that a newer one replaced before a tick showed them
    Percentiles late_ms;         ///< from a tick to the hand-over of its frame
    double duration_s = 0;       ///< since the first frame
    Percentiles interval_ms;     ///< between two newly rendered frames
    Percentiles latency_ms;  ///< from exposure to the hand-over of the first frame rendered from it
    Percentiles
        input_ms;         ///< input latency: from input to the hand-over of the first frame with it
    Percentiles seek_ms;  ///< from a jump in time to the hand-over of the frame of its target
    SeekSteps<Percentiles> seek_steps_ms;
    Percentiles rest_ms;  ///< from the last change of camera and time to the frame at best quality
    Percentiles render_ms, readback_ms;
    std::vector<double> render_shares, prepare_shares;  ///< shares of the time, by level
    std::uint64_t preview_pictures = 0;
    Percentiles preview_ms;  ///< of a frame of the preview, with its waits for the programme
    int faults = 0;          ///< number of times that a renderer was recreated
    std::vector<SinkState> sinks;
};

/// Records ProgrammeStats. The programme's thread writes, and any thread may read.
class ProgrammeRecorder {
  public:
    void set_level_shares(std::vector<double> render, std::vector<double> prepare);
    void count_replaced_frame();
    /// A tick, or several that have passed, for which a frame is handed to the sinks.
    struct HandOver {
        const MadePicture* fresh = nullptr;        ///< newly rendered; null: none
        const MadePicture* reprojected = nullptr;  ///< the frame, if it is a reprojection
        bool was_due = false;                      ///< a new frame was due
        std::uint64_t passed_ticks = 1;
        MonotonicTime due{}, now{};  ///< of the first of them; of the hand-over
        int faults = 0;              ///< number of times that a renderer was recreated
    };
    /// Returns the latency of a fresh frame if it is the first one of its exposure.
    std::optional<double> record(const HandOver& frame);
    void record_rest(double ms);
    /// `pictures` of the preview so far, of which the last took `ms`.
    void record_preview(std::uint64_t pictures, double ms);

    std::uint64_t ticks() const;
    /// Everything that this class records.
    ProgrammeStats stats() const;

  private:
    std::optional<double> record_fresh(const MadePicture& made, MonotonicTime now);

    mutable std::mutex mutex_;
    ProgrammeStats stats_;
    std::optional<MonotonicTime> first_frame_, last_new_;
    std::uint64_t latency_pulse_ = 0;  ///< pulse whose latency was measured last
    PercentileRecorder reprojected_way_, late_ms_, interval_ms_, latency_ms_, rest_ms_, render_ms_,
        readback_ms_, preview_ms_;
};

}  // namespace vantage
