#include "host_app/live/window_flight.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_app/flight/orbit_camera.h"
#include "host_app/live/output_clock.h"
#include "host_app/live/panel_feed.h"

namespace vantage {
namespace {

/// The virtual camera between a planned move and the operator's hands.
class Helm {
  public:
    explicit Helm(const FlightPlan& plan)
        : camera_(plan.start), start_(plan.start), move_(plan.move) {
        if (move_) move_start_s_ = 0;
    }

    void take(const OperatorInput& input, const LiveSession& session, double time_s) {
        if (input.toggle_move && move_) {
            if (playing())
                leave_move(time_s);
            else
                move_start_s_ = time_s;
        }
        if (input.store_shot) shots_[shot(input.store_shot)] = view(time_s);
        if (!input.steers()) return;
        if (playing()) leave_move(time_s);
        camera_.orbit(input.orbit_azimuth_rad, input.orbit_elevation_rad);
        camera_.pan(input.pan_right_widths, input.pan_up_widths);
        camera_.dolly(input.dolly);
        camera_.zoom(input.zoom);
        if (input.reset) camera_.fly_to(start_);
        if (input.recall_shot) recall(input.recall_shot, session);
    }
    void advance(double dt_s) { camera_.advance(dt_s); }

    OrbitView view(double time_s) const {
        return playing() ? move_->at(time_s - *move_start_s_) : camera_.view();
    }
    std::optional<double> move_progress(double time_s) const {
        if (!playing()) return std::nullopt;
        const double turns = (time_s - *move_start_s_) / move_->duration_s();
        return move_->loops() ? turns - std::floor(turns) : std::min(turns, 1.0);
    }

  private:
    static std::size_t shot(int number) { return static_cast<std::size_t>(number - 1); }
    bool playing() const { return move_start_s_.has_value(); }

    void leave_move(double time_s) {
        camera_.jump_to(view(time_s));
        move_start_s_.reset();
    }

    /// A shot that nobody stored is what the rig of that number sees.
    void recall(int number, const LiveSession& session) {
        if (shots_[shot(number)]) {
            camera_.fly_to(*shots_[shot(number)]);
            return;
        }
        const FrameSet* set = session.shown();
        if (!set || shot(number) >= set->slots.size() || !set->slots[shot(number)].frame) return;
        const RigFrame& frame = *set->slots[shot(number)].frame;
        const double field_of_view_rad =
            2 * std::atan(0.5 * frame.geometry.width_px / frame.geometry.f_px);
        // The point on the rig's axis that is nearest to the stage's pivot.
        const Eigen::Vector3d eye = frame.world_from_camera.translation();
        const Eigen::Vector3d axis = frame.world_from_camera.linear().col(2);
        const double distance_m = std::max(0.5, axis.dot(start_.pivot_m - eye));
        camera_.fly_to(view_from_eye(eye, eye + distance_m * axis, field_of_view_rad));
    }

    OrbitCamera camera_;
    OrbitView start_;
    std::optional<Move> move_;
    std::optional<double> move_start_s_;  ///< on the output's clock, while a move plays
    std::array<std::optional<OrbitView>, 9> shots_;
};

}  // namespace

std::uint64_t fly_in_window(LiveSession& session, OperatorWindow& window, const FlightPlan& plan,
                            double rate_hz, StopSignal& stop) {
    Helm helm(plan);
    PanelFeed panel;
    OutputClock clock(rate_hz, MonotonicClock::now());
    double last_s = 0;
    for (std::uint64_t pictures = 0;; ++pictures) {
        if (stop.wait_for(clock.until_next(MonotonicClock::now()))) break;
        const std::chrono::nanoseconds time = clock.time_of(clock.next_tick(MonotonicClock::now()));
        const double time_s = std::chrono::duration<double>(time).count();
        if (plan.is_over(pictures, time_s)) break;
        const OperatorInput input = window.poll(time_s - last_s);
        if (window.closed()) break;
        if (input.toggle_freeze) session.set_frozen(!session.frozen());
        if (input.next_synthesiser) session.next_synthesiser();
        helm.take(input, session, time_s);
        helm.advance(time_s - last_s);
        last_s = time_s;
        const OrbitView view = helm.view(time_s);
        const Texture& picture = session.make_picture(view, time);
        window.show(panel.state(session, picture, view, helm.move_progress(time_s), pictures));
    }
    return clock.skipped();
}

}  // namespace vantage
