#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/rate_meter.h"
#include "host_app/desk/desk_state.h"
#include "host_app/desk/feed/clip_pictures.h"
#include "host_app/desk/feed/rig_pictures.h"
#include "host_app/desk/feed/shot_pictures.h"
#include "host_app/desk/feed/shown_picture.h"
#include "host_app/session/corridor_fields.h"
#include "host_app/session/live_show.h"

namespace vantage {

/// Puts together what the operator's desk tells, from the show's books. Rates, latencies and the
/// rigs' pictures are looked at a few times a second, so that numbers can be read. Of one context,
/// which must be current at every call.
class DeskFeed {
  public:
    /// The programme's newest picture; null before the first.
    const Texture* picture(const ProgrammeState& programme) {
        return programme_picture_.follow(programme.picture);
    }
    /// That of the camera on preview; null: there is none.
    const Texture* preview(const ProgrammeState& programme) {
        return preview_picture_.follow(programme.preview.picture);
    }
    /// To be called when that was shown.
    void note_shown(const ProgrammeState& programme);
    /// `take`: nothing: none is recorded here. `question`: that a second press of a key answers;
    /// empty: none. `wants_points`: the stage is looked at from outside.
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
    std::map<std::string, MonotonicTime> rigs_seen_;  ///< in a set, last
    RigPictures rig_pictures_;
    ShotPictures shot_pictures_;
    ClipPictures clip_pictures_;
    std::uint64_t notices_ = 0;  ///< of replay, that were seen
    MonotonicTime noticed_{};    ///< the last of them
    CorridorFields corridor_;
    std::vector<DeskPlan::Point> points_;
    std::shared_ptr<const FrameSet> points_of_;
    std::deque<Placed> path_;
    std::shared_ptr<const Move> move_;  ///< of which these are
    std::vector<Eigen::Vector3d> move_m_, keyframes_m_;
    std::deque<float> latencies_ms_;  ///< from exposure to this desk's window
    std::uint64_t latency_of_ = 0;    ///< the pulse of the last of them
    std::string renderer_;
    ShownPicture programme_picture_, preview_picture_;
    RateMeter preview_rate_;
    std::optional<SetTimecode> timecodes_;  ///< of the stage's pulses
    DeskState state_;
};

}  // namespace vantage
