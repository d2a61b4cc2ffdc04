#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_deck.h"
#include "host_app/control/hid/jog_mapper.h"
#include "host_app/flight/helm.h"
#include "host_app/live/flight_plan.h"
#include "host_app/live/live_session.h"

namespace vantage {

/// All hands on the virtual camera: mouse and keyboard where there is a window, and the jog wheels
/// of the deck. Whatever came until a picture is begun is in that picture.
class FlightControls {
  public:
    /// Without a deck there are no wheels; else it must outlive this.
    FlightControls(const FlightPlan& plan, const LiveSession& session, JogDeck* deck)
        : helm_(plan.start, plan.move, session.keeps_past()),
          pivot_m_(plan.start.pivot_m),
          deck_(deck) {}

    /// Takes everything in, up to `time_s` after the start of the output (times must grow), and
    /// gives the view for the next picture. Throws what the deck throws.
    OrbitView step(FlightInput hands, LiveSession& session, double time_s);

    std::optional<double> move_progress() const { return helm_.move_progress(); }
    /// One line for the operator: the wheels, what they drive, and what is wrong with one.
    std::string wheel_line() const;

  private:
    std::optional<OrbitView> rig_view(const LiveSession& session, int number) const;

    Helm helm_;
    Eigen::Vector3d pivot_m_;
    JogDeck* deck_;
    JogMapper mapper_;
    double last_s_ = 0;
};

}  // namespace vantage
