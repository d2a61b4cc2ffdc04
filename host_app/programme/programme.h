#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "host_app/flight/camera_source.h"
#include "host_app/flight/camera_state.h"
#include "host_app/pipeline/instant_thread.h"
#include "host_app/programme/governor.h"
#include "host_app/programme/picture_maker.h"
#include "host_app/programme/picture_sinks.h"
#include "host_app/programme/preview.h"
#include "host_app/programme/programme_sound.h"
#include "host_app/programme/reprojector.h"
#include "host_app/programme/stats/input_latency.h"
#include "host_app/programme/stats/programme_stats.h"
#include "host_app/programme/stats/render_timing.h"
#include "host_app/programme/stats/seek_watch.h"
#include "host_app/programme/synthesiser_switch.h"
#include "host_app/replay/replay.h"

namespace vantage {

/// Status of the programme, for the desk and the lamps.
struct ProgrammeState {
    std::shared_ptr<const MadePicture> picture;  ///< null before the first frame
    OrbitView view;
    struct Preview {
        std::optional<OrbitView> view;               ///< empty: there is no camera on preview
        std::shared_ptr<const MadePicture> picture;  ///< null before its first frame
        std::uint64_t pictures = 0;                  ///< number of its frames so far
    } preview;
    bool source_map = false;
    TransportState time;
    ReplayState replay;
    std::optional<PastFrameSets::Span> past;  ///< empty: there is no past
    std::optional<double> behind_s;           ///< delay behind live; empty unless in a stage's past
    std::string synthesiser;
    double latency_ms = 0;

    // Quality levels of the frame on screen; 0 is the best, and the value before the first frame.
    int render_level() const { return picture ? picture->job.level.rank : 0; }
    int prepare_level() const { return picture ? picture->job.instant->instant->level : 0; }
};

/// The clock of the programme. At every tick it hands the newest frame to the sinks, and it starts
/// the next frame from the newest camera and the newest prepared instant. It waits for nothing but
/// its ticks: a tick whose frame is not ready gets the last one, reprojected to the present camera
/// if possible, and is counted. It runs on its own thread.
class Programme {
  public:
    struct Settings {
        PictureFormat format;
        double rate_hz = 30, pulse_rate_hz = 30;
        std::string synthesiser = default_synthesiser;
        QualityRequest quality;
        bool source_map = false;                        ///< at the start
        Replay replay = {};                             ///< at the start
        bool ends_with_past = false;                    ///< end after the last frame of a take
        std::shared_ptr<PictureSound> sound = nullptr;  ///< null: no sound
    };
    /// Renders on contexts of the group of `instants`. `instants` and `camera_source` must outlive
    /// this object.
    Programme(Settings settings, InstantThread& instants, CameraSource& camera_source);
    ~Programme();
    Programme(const Programme&) = delete;
    Programme& operator=(const Programme&) = delete;

    /// To be called before start().
    void add(std::unique_ptr<PictureSink> sink) { sinks_.add(std::move(sink)); }
    /// Starts the ticks. The programme ends when `is_over` returns true, which it asks at every
    /// tick with the number of ticks and the time so far.
    void start(std::function<bool(std::uint64_t pictures, double time_s)> is_over);
    /// Whether the programme ended by itself. Throws the error that ended it.
    bool is_over() const;
    /// Ends the ticks, and then the sinks.
    void stop();

    ProgrammeState state() const;
    ProgrammeStats stats() const;

  private:
    /// The operator's camera at the present step and at the one before.
    struct CameraTrack {
        OrbitView view;
        CameraState now, before;
        CameraForecast forecast;
        std::optional<OrbitView> preview;

        bool is_still() const { return is_same_view(now, before); }
    };
    /// Frames on their way to the sinks; null: none.
    struct Frames {
        std::shared_ptr<const MadePicture> rendered;     ///< not handed over yet
        std::shared_ptr<const MadePicture> reprojected;  ///< not handed over yet
        std::shared_ptr<const MadePicture> shown;  ///< the last rendered frame that was handed over
        std::shared_ptr<const MadePicture> handed;  ///< the same, or a reprojection of it

        const std::shared_ptr<const MadePicture>& newest_rendered() const {
            return rendered ? rendered : shown;
        }
        bool can_reproject() const { return shown && !shown->inverse_depth.empty(); }
    };
    void run();
    /// Before the first tick: renders the newest instant at all levels, so that drivers compile.
    void warm_up();

    /// Takes a step of camera and time; true if a new frame is due.
    bool take_step(double time_s, MonotonicTime now);
    void take_time(CameraStep& step, double time_s, const std::optional<PastFrameSets::Span>& span);
    void update_state(const std::optional<PastFrameSets::Span>& span, MonotonicTime now);
    void request_instant(MonotonicTime now);
    /// Time until the middle of the period in which an instant that is requested now is shown.
    double shown_in_s() const;

    /// The frame to render now.
    PictureJob wanted_picture() const;
    /// Whether a frame rendered now would differ from the one on screen.
    bool is_picture_due() const;
    /// Whether rendering pays. It does not if the due frame is waiting to be handed over. If frames
    /// are long, it does not either where a reprojection shows the small motion of the camera as
    /// well; the time is then left to instants.
    bool is_worth_rendering();
    /// Whether the time budget allows a frame. Long frames leave the rest of the time to instants.
    bool has_picture_time(MonotonicTime now);
    /// Whether operator input waits that only a newly rendered frame can show.
    bool is_input_waiting_for_rendering() const;
    bool are_pictures_long() const { return frames_.can_reproject() && timing_.are_frames_long(); }
    /// After a jump in time, takes over an instant that became ready since the step, so that the
    /// next tick shows it. True if there was one.
    bool take_sought_instant();
    void begin_picture();
    /// Starts to reproject the newest frame if the camera has moved on.
    void begin_reprojection();
    /// Renders the best frame of an instant and a camera that stand still.
    void refine_held_instant(MonotonicTime now);

    /// Collects finished frames and reprojections.
    void take_finished();
    void take_still(MonotonicTime now);
    /// Takes the reprojection to hand over; null if a rendered frame is as new.
    std::shared_ptr<const MadePicture> take_reprojection();
    /// Hands a frame to the sinks for all ticks that have passed, of which the first was due at
    /// `due`.
    void hand_over(std::uint64_t passed_ticks, bool was_due, MonotonicTime due);
    void give_to_sinks(const MadePicture& shown, std::uint64_t ticks, MonotonicTime due);
    /// Records a newly rendered frame.
    void note(const MadePicture& made, MonotonicTime now);
    /// Records the time from the last change to the frame at best quality.
    void note_rest(const MadePicture& made, MonotonicTime now);
    void follow_preview();
    void follow_synthesiser();

    const Transport& transport() const { return replay_.transport(); }
    /// Pulse of the playback position; empty if there is none.
    std::optional<std::uint64_t> past_pulse() const;
    std::chrono::nanoseconds reprojection_lead() const {
        return timing_.lead_of(reprojector_.longest_ms());
    }
    std::chrono::nanoseconds lead() const {
        return timing_.lead(frames_.can_reproject(), reprojection_lead());
    }

    Settings settings_;
    InstantThread& instants_;
    CameraSource& camera_source_;
    PictureSinks sinks_;
    std::function<bool(std::uint64_t, double)> is_over_;

    // Used on the programme's thread only.
    Governor governor_;
    Replay replay_;
    RenderTiming timing_;
    SynthesiserSwitch synthesisers_;
    StillRefiner still_;
    Preview preview_;
    Reprojector reprojector_;
    ProgrammeSound sound_;
    InputLatency input_latency_;  ///< its measurements are guarded by mutex_
    SeekWatch seek_;              ///< its measurements are guarded by mutex_
    CameraTrack camera_;
    Frames frames_;
    std::shared_ptr<const ReadyInstant> instant_;
    std::optional<PictureJob> begun_;  ///< the last frame that was started
    std::uint64_t step_ = 0;           ///< number of the present step
    std::optional<double> last_step_s_;
    MonotonicTime changed_{};     ///< last change of camera or time
    MonotonicTime rest_noted_{};  ///< the change whose best frame was recorded
    std::uint64_t sink_ticks_ = 0;
    std::uint64_t noted_instant_ = 0;  ///< number of the last instant that the governor has seen
    int moments_a_pulse_ = 1;          ///< see InstantRequest
    bool source_map_;

    ProgrammeRecorder recorder_;  ///< thread-safe
    mutable std::mutex mutex_;
    // Guarded by mutex_.
    ProgrammeState state_;
    std::exception_ptr failure_;
    bool is_ended_ = false;
    std::atomic<bool> is_stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
