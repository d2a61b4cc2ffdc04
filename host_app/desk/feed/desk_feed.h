#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/rate_meter.h"
#include "host_app/desk/desk_state.h"
#include "host_app/desk/feed/desk_pictures.h"
#include "host_app/desk/feed/stage_map.h"
#include "host_app/session/live_show.h"

namespace vantage {

/// The newest picture of a camera as a texture of the context that is current.
class ShownPicture {
  public:
    /// Uploads the picture if it is new. Null while there is none.
    const Texture* follow(const std::shared_ptr<const MadePicture>& newest);

  private:
    std::optional<Texture> texture_;
    std::shared_ptr<const MadePicture> uploaded_;
};

/// Builds the desk's values from the state of a show. Rates, latencies and the rigs' pictures are
/// refreshed four times a second, so that the numbers can be read. It owns the textures and must
/// always be called with the same context current.
class DeskFeed {
  public:
    /// The programme's newest picture; null before the first one.
    const Texture* picture(const ProgrammeState& programme) {
        return programme_picture_.follow(programme.picture);
    }
    /// The newest picture of the camera on preview; null if there is none.
    const Texture* preview(const ProgrammeState& programme) {
        return preview_picture_.follow(programme.preview.picture);
    }
    /// Records the latency of a picture. Call it when the picture was shown.
    void note_shown(const ProgrammeState& programme);
    /// Returns the desk's values. `take` is nothing if no take is recorded here, `question` is
    /// empty unless a second key press is asked for, `wants_points` is set while the 3-D view is
    /// shown.
    DeskState state(LiveShow& show, const ProgrammeState& programme,
                    const std::optional<TakeState>& take, const std::string& question,
                    bool wants_points);

  private:
    void refresh(LiveShow& show, const ProgrammeState& programme, const FrameSet* set,
                 MonotonicTime now);
    static std::optional<DeskSources> sources_of(const ProgrammeState& programme);
    DeskRig rig_of(const RigAccount& account, const FrameSet* set, MonotonicTime now);
    void follow_move(const LiveShow& show);
    void follow_plan(const LiveShow& show, const ProgrammeState& programme, MonotonicTime now);
    void follow_replay(const ProgrammeState& programme, const FrameSet* set, MonotonicTime now);
    void follow_preview(const FlightControls::Lines& lines, const ProgrammeState& programme);
    void follow_points(const ProgrammeState& programme, bool are_wanted);
    void follow_shots(const LiveShow& show, const ProgrammeState& programme, MonotonicTime now);

    struct Placed {
        MonotonicTime time;
        Eigen::Vector3d eye_m;
    };
    std::optional<MonotonicTime> refreshed_;
    RateMeter picture_rate_, repeat_rate_;
    std::map<std::string, RateMeter> rig_rates_;
    std::map<std::string, MonotonicTime> rigs_seen_;  ///< last time in a frame set
    RigPictures rig_pictures_;
    ShotPictures shot_pictures_;
    ClipPictures clip_pictures_;
    std::uint64_t notices_ = 0;  ///< number of replay notices so far
    MonotonicTime noticed_{};    ///< time of the last one
    CorridorFields corridor_;
    std::vector<DeskPlan::Point> points_;
    std::shared_ptr<const FrameSet> points_of_;
    std::deque<Placed> path_;
    std::shared_ptr<const Move> move_;  ///< source of the two lines below
    std::vector<Eigen::Vector3d> move_m_, keyframes_m_;
    std::deque<float> latencies_ms_;  ///< from exposure to the desk's window
    std::uint64_t latency_of_ = 0;    ///< pulse of the last one
    std::string renderer_;
    ShownPicture programme_picture_, preview_picture_;
    RateMeter preview_rate_;
    std::optional<SetTimecode> timecodes_;
    DeskState state_;
};

}  // namespace vantage
