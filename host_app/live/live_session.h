#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/base/stop_signal.h"
#include "common/colour/colour_correction.h"
#include "host_app/flight/orbit_view.h"
#include "host_app/live/live_report.h"
#include "host_app/live/moment_collector.h"
#include "host_app/live/newest_set.h"
#include "host_app/live/past_ring.h"
#include "host_app/live/stage_times.h"
#include "host_app/output/video_recorder.h"
#include "host_app/synthesis/colour_harmoniser.h"
#include "host_app/synthesis/novelty_overlay.h"
#include "host_app/synthesis/rig_demand.h"
#include "host_app/synthesis/stereoscopy.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

struct LiveSettings {
    int width_px = 1280, height_px = 720;  ///< of the virtual view
    double rate_hz = 30;                   ///< of the output
    double pulse_rate_hz = 30;             ///< of the stage
    std::size_t past_bytes = 0;            ///< of frames kept to go back to; 0: none
    std::string synthesiser = "fused";
    bool novelty = false;  ///< the picture is a NoveltyOverlay
    /// Two eyes side by side that converge, where this does not say, at the pivot's distance.
    std::optional<Stereoscopy> stereoscopy = {};
    std::filesystem::path film, contact_sheet;  ///< empty: none
    bool harmonise = true;                      ///< the rigs' colours, by a ColourHarmoniser
    std::map<std::string, ColourCorrection> colours = {};  ///< by rig; others stay as they are
};

/// From frame sets to pictures of the virtual camera: takes the newest set, renders, hands the
/// picture to the film and the contact sheet, and keeps the books. Lives on the thread of the GL
/// context, which must be current.
class LiveSession {
  public:
    /// Throws Error if the synthesiser is unknown, or cannot tell what the novelty overlay is to
    /// show, or there can be no stereoscopic picture of this width, or the film cannot be opened.
    LiveSession(const LiveSettings& settings, const ShaderLibrary& shaders, StageFeed feed);

    /// Waits until a set with all rigs has come; at the limit, goes on with those that are there
    /// and says which are missing. Throws Error, with every rig's state, if none came or the
    /// program was asked to stop meanwhile, and at once if all rigs refuse this host.
    void wait_for_rigs(std::chrono::nanoseconds limit, StopSignal& stop);

    /// Renders the newest set from `view`, for the moment `time` after the start of the output;
    /// times must grow. The texture is valid until the next call. Throws Error if the film fails.
    const Texture& make_picture(const OrbitView& view, std::chrono::nanoseconds time);

    /// Frozen, the set that is shown stays; the camera may still fly.
    void set_frozen(bool frozen) { frozen_ = frozen; }
    bool frozen() const { return frozen_; }

    /// Goes by so many pulses, either way, through what is kept of the past; from the live set, or
    /// from where it is already. There it stands, whatever comes meanwhile, until to_live().
    void travel(double pulses);
    /// To the newest set, neither in the past nor frozen.
    void to_live();
    /// Whether there is a past to go to.
    bool keeps_past() const { return settings_.past_bytes > 0; }
    /// How long before the newest set the one that is shown was, while in the past.
    std::optional<double> behind_s() const;
    double pulse_rate_hz() const { return settings_.pulse_rate_hz; }

    bool recording() const { return recorder_.has_value(); }

    /// The picture that was made last, read back. Precondition: there is one.
    ColourImage last_picture() const { return last_texture_->download(); }

    /// Of the picture that was made last.
    const OrbitView& last_view() const { return last_view_; }

    /// Changes to the registered synthesiser after the current one.
    void next_synthesiser();
    const std::string& synthesiser() const { return settings_.synthesiser; }

    /// The picture, also in films, shows which rigs its pixels come from, as long as the
    /// synthesiser can tell.
    void set_novelty(bool novelty);
    bool novelty() const { return settings_.novelty; }
    const std::vector<NoveltyOverlay::Key>& novelty_legend() const { return overlay_.legend(); }
    /// Of the picture that was made last; nothing if it shows no novelty. Waits for the GPU.
    std::optional<NoveltyShares> last_shares() const;

    /// The set that is shown; null before the first.
    const FrameSet* shown() const { return shown_ ? &*shown_ : nullptr; }
    /// Grows with every set that is shown.
    std::uint64_t sets_shown() const { return sets_fused_; }
    /// All stages but the encoder's; network and decode as of the last refresh_status().
    std::vector<StageTime> stage_summary() const;
    /// Of the set that was shown last, from exposure to picture.
    double latest_latency_ms() const { return latest_latency_ms_; }
    const ReceiverStatus& refresh_status();

    /// Closes the books, ends the film and writes the contact sheet; without a picture there is
    /// neither. No picture can be made afterwards. Throws Error if a file cannot be written.
    void finish();

    /// Precondition: finish().
    LiveReport report() const;

  private:
    void show(FrameSet set);
    /// The picture of one camera, with the overlay if that is wanted.
    const Texture& render_eye(const VirtualView& eye);
    const Texture& render(const VirtualView& target, double focus_m);
    std::vector<DepthView> views_of(const FrameSet& set) const;
    void give_to_synthesiser(std::vector<DepthView> views, std::uint64_t trigger_index);
    /// Asks the rigs that the view needs to send, and the others to stop.
    void ask_for_rigs(const VirtualView& view);
    void keep_moment(const OrbitView& view, std::chrono::nanoseconds time,
                     const ColourImage& picture);

    LiveSettings settings_;
    const ShaderLibrary* shaders_;
    PastRing past_;
    NewestSet newest_;
    ReceiverStatus status_;
    std::unique_ptr<Synthesiser> synthesiser_;
    NoveltyOverlay overlay_;
    SideBySide side_by_side_;
    RigDemand demand_;
    ColourHarmoniser harmoniser_;
    std::uint64_t last_harmonised_ = 0;  ///< pulse
    std::optional<VideoRecorder> recorder_;
    MomentCollector moments_;

    const Texture* last_texture_ = nullptr;
    const Texture* last_eye_ = nullptr;  ///< the picture that the synthesiser's origins belong to
    OrbitView last_view_;
    std::optional<FrameSet> shown_;
    bool is_new_ = false;  ///< shown_ was in no picture yet
    bool frozen_ = false;
    std::optional<double> past_pulse_;  ///< where in the past

    StageTimes times_;
    PercentileRecorder latency_ms_;
    double latest_latency_ms_ = 0;
    RigCounts fused_;
    std::uint64_t sets_fused_ = 0, pictures_ = 0;
    std::optional<MonotonicTime> first_picture_;
    MonotonicTime last_picture_{};
};

}  // namespace vantage
