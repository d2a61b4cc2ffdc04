#pragma once

#include <atomic>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/percentiles.h"
#include "common/base/time/time_budget.h"
#include "host_app/flight/camera_forecast.h"
#include "host_app/flight/camera_source.h"
#include "host_app/pipeline/instant_thread.h"
#include "host_app/programme/governor.h"
#include "host_app/programme/input_latency.h"
#include "host_app/programme/picture_maker.h"
#include "host_app/programme/picture_sinks.h"
#include "host_app/programme/preview.h"
#include "host_app/programme/reprojection.h"
#include "host_app/programme/reprojector.h"
#include "host_app/programme/seek_watch.h"
#include "host_app/replay/replay.h"
#include "host_app/sound/picture_sound.h"

namespace vantage {

/// What the programme counted and measured.
struct ProgrammeStats {
    std::uint64_t ticks = 0;        ///< since the first picture
    std::uint64_t pictures = 0;     ///< ticks with a new one
    std::uint64_t reprojected = 0;  ///< ticks for which a new one was due and not ready, and which
                                    ///< got the last one as the camera would see it now
    Percentiles reprojected_way;    ///< of all that were reprojected, new ones too, in shares of
                                    ///< the picture's width
    std::uint64_t repeated = 0;     ///< such ticks that got the last one as it was
    std::uint64_t missed = 0;       ///< of those, ticks that had passed before the programme came
                                    ///< to them; sinks were given them late
    std::uint64_t superseded = 0;   ///< pictures that no tick showed: a newer one was ready before
    Percentiles late_ms;            ///< from a tick to the hand-over of its picture
    double duration_s = 0;          ///< since the first picture
    Percentiles interval_ms;        ///< between two new pictures
    Percentiles latency_ms;         ///< from exposure to the hand-over of the first picture of it
    Percentiles input_ms;  ///< from an input that moves the camera or changes what is drawn to the
                          ///< hand-over of the first picture with it
    Percentiles seek_ms;  ///< from a jump in time to the hand-over of its instant's picture
    SeekSteps<Percentiles> seek_steps_ms;
    Percentiles rest_ms;  ///< from the last change of camera and time to the best picture
    Percentiles render_ms, readback_ms;
    std::vector<double> render_shares, prepare_shares;  ///< of the time, by level
    std::uint64_t preview_pictures = 0;
    Percentiles preview_ms;  ///< that one took, waiting for the programme included
    int faults = 0;          ///< renderers that were made anew
    std::vector<SinkState> sinks;
};

/// How the programme stands, for the desk.
struct ProgrammeState {
    std::shared_ptr<const MadePicture> picture;  ///< null before the first
    OrbitView view;
    /// Of the camera on preview.
    struct Preview {
        std::optional<OrbitView> view;               ///< nothing: there is none
        std::shared_ptr<const MadePicture> picture;  ///< null before the first
        std::uint64_t pictures = 0;                  ///< so far
    } preview;
    bool source_map = false;
    TransportState time;
    ReplayState replay;
    std::optional<PastFrameSets::Span> past;  ///< that there is
    std::optional<double> behind_s;      ///< in a stage's past: how far
    std::string synthesiser;
    double latency_ms = 0;

    // Of the picture's quality; 0 is the best, and before the first.
    int render_level() const { return picture ? picture->job.level.rank : 0; }
    int prepare_level() const { return picture ? picture->job.instant->instant->level : 0; }
};

/// The programme's clock: at every tick the newest picture goes to the sinks, and the next one is
/// begun, of the newest camera and the newest ready instant. It waits for nothing but its ticks: a
/// tick without a new picture gets the last one, reprojected to where the camera is meanwhile or as
/// it was, and is counted.
class Programme {
  public:
    struct Settings {
        PictureFormat format;
        double rate_hz = 30, pulse_rate_hz = 30;
        std::string synthesiser = default_synthesiser;
        QualityRequest quality;
        bool source_map = false;                        ///< shown at first
        Replay replay = {};                             ///< at first
        bool ends_with_past = false;                    ///< once the end of what is played is shown
        std::shared_ptr<PictureSound> sound = nullptr;  ///< that goes with it; null: none
    };
    /// Draws on contexts of the instants' group. Runs from start() on. `pilot` and `instants` must
    /// outlive it.
    Programme(Settings settings, InstantThread& instants, CameraSource& camera_source);
    ~Programme();
    Programme(const Programme&) = delete;
    Programme& operator=(const Programme&) = delete;

    /// Before start().
    void add(std::unique_ptr<PictureSink> sink) { sinks_.add(std::move(sink)); }
    /// `is_over` is asked at every tick: pictures so far and seconds since the first tick.
    void start(std::function<bool(std::uint64_t pictures, double time_s)> is_over);
    /// Whether it ended by itself. Throws what ended it.
    bool is_over() const;
    /// Ends the ticks, then the sinks.
    void stop();

    ProgrammeState state() const;
    ProgrammeStats stats() const;

  private:
    /// Makes a synthesiser's pictures. Kept when another takes over: drivers give back little of
    /// what a renderer has taken, and who comes back need not compile again.
    struct Renderer {
        SynthesiserEntry synthesiser;
        std::unique_ptr<PictureMaker> maker;
        std::unique_ptr<PictureMaker> still;  ///< of what is held; null: nothing was yet
    };
    void run();
    /// Before the first tick: pictures at all levels of the newest instant, which nobody sees.
    void warm_up();
    /// Asks hands and plans; true if a picture is due.
    bool look(double time_s, MonotonicTime now);
    /// Of now.
    PictureJob wanted_picture() const;
    /// Whether a picture of now would differ from the one that is shown.
    bool is_picture_due() const;
    /// The picture that is shown has the depth for it.
    bool can_reproject() const;
    /// Of the last pictures; 0 before there are some.
    double usual_make_ms() const;
    bool are_pictures_long() const;
    /// False where the picture that is due waits to be handed over, and where pictures take long
    /// and it would differ from the last one by a short way of the camera alone, which a
    /// reprojection shows as well: the time is for instants.
    bool is_worth_rendering();
    /// False where pictures that take longer than their ticks have had their share of the time: the
    /// rest is for the instants beside them.
    bool has_picture_time(MonotonicTime now);
    /// What an operator asked for comes to light by a new picture alone: instants wait for that.
    bool is_input_waiting_for_rendering() const;
    /// While a jump is waited for: what has become ready since the look is shown at the next tick,
    /// not a tick later. True if something has.
    bool take_up_sought();
    void request_instant(MonotonicTime now);
    /// Until the middle of the time for which an instant that is wished for now will be shown.
    double shown_in_s() const;
    void begin_picture();
    /// What the maker and the reprojector finished waits to be handed over.
    void take_finished();
    /// Handed over or not yet; null before the first.
    const std::shared_ptr<const MadePicture>& newest_rendered() const {
        return rendered_ ? rendered_ : shown_;
    }
    /// Carries the newest picture on to the camera, if that has left it.
    void begin_reprojection();
    /// Of the past, that time stands at; nothing: there is none.
    std::optional<std::uint64_t> past_pulse() const;
    void refine_held_instant(MonotonicTime now);
    /// The better picture of it, if that is ready.
    void take_still(MonotonicTime now);
    /// Compiles where it is asked for the first time.
    Renderer& renderer_of(const SynthesiserEntry& synthesiser);
    void begin_next_synthesiser();
    void follow_preview();
    void follow_synthesiser();
    /// The reprojection to hand over; null if what was rendered is as new, or is shown.
    std::shared_ptr<const MadePicture> newest_carried();
    /// `due`: the first of the ticks that have passed.
    void hand_over(std::uint64_t passed_ticks, bool was_due, MonotonicTime due);
    void give_to_sinks(const MadePicture& shown, std::uint64_t ticks, MonotonicTime due);
    /// Of the tick that was due then, so many ticks after the one for which time was looked at.
    PictureSound::Tick sound_tick(MonotonicTime due, std::uint64_t later) const;
    void note_sound_delay(const ReadyInstant& instant);
    void note(const MadePicture& made, MonotonicTime now);
    void note_rest(const MadePicture& made, MonotonicTime now);
    const Transport& transport() const { return replay_.transport(); }
    /// How long before a tick its picture is to be begun.
    std::chrono::nanoseconds lead() const;
    /// The same of its reprojection.
    std::chrono::nanoseconds reprojection_lead() const;

    Settings settings_;
    InstantThread& instants_;
    CameraSource& camera_source_;
    PictureSinks sinks_;
    std::function<bool(std::uint64_t, double)> is_over_;

    // Of the programme's thread.
    Governor governor_;
    Replay replay_;
    std::optional<double> last_look_s_;
    std::uint64_t look_ = 0;                     ///< so many
    std::map<std::string, Renderer> renderers_;  ///< by synthesiser
    Renderer* renderer_ = nullptr;               ///< in use
    Renderer* next_ = nullptr;                   ///< takes over when it is ready; null: none
    Preview preview_;
    std::optional<OrbitView> preview_view_;
    OrbitView view_;
    CameraState camera_, camera_before_;  ///< of the last look and the one before
    CameraForecast forecast_;
    InputLatency operator_input_;
    SeekWatch seek_;
    std::shared_ptr<const ReadyInstant> instant_;
    std::optional<PictureJob> begun_, begun_still_;
    std::shared_ptr<const MadePicture> rendered_;  ///< not handed over yet; null: none
    std::shared_ptr<const MadePicture> shown_;     ///< the last one that was rendered
    std::shared_ptr<const MadePicture> handed_;    ///< the same, or a reprojection of it
    Reprojector reprojector_;
    std::shared_ptr<const MadePicture> carried_;  ///< by it, not handed over yet; null: none
    MonotonicTime changed_{};                     ///< camera or time, last
    MonotonicTime rest_noted_{};  ///< of the rest since then the best picture was shown
    std::optional<MonotonicTime> first_picture_, last_new_;
    std::uint64_t sink_ticks_ = 0, seen_prepared_ = 0, latency_of_ = 0, sound_of_ = 0;
    bool source_map_ = false;
    int moments_a_pulse_ = 1;     ///< as InstantWish
    std::deque<double> make_ms_;  ///< of the last pictures
    TimeBudget picture_time_;      ///< beside instants

    mutable std::mutex mutex_;
    ProgrammeState state_;
    ProgrammeStats stats_;
    PercentileRecorder reprojected_way_, late_ms_, interval_ms_, latency_ms_, rest_ms_, render_ms_,
        readback_ms_, preview_ms_;
    std::exception_ptr failure_;
    bool is_ended_ = false;
    std::atomic<bool> is_stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
