#pragma once

#include <map>
#include <string>

#include "host_app/control/hid/jog_devices.h"
#include "host_app/flight/flight_input.h"

namespace vantage {

/// Playback speed for a position 0..1 of a shuttle ring, with the steps that operators know: 0,
/// 0.1, 0.25, 0.33, 0.5, 0.75, 1, 2, linear in between; negative backwards.
double shuttle_speed(double position);

/// Converts the events of jog devices to flight input, by the profiles of the wheels. Not
/// thread-safe.
class JogMapper {
  public:
    void take(const DeckEvent& event);

    /// Input since the last call, including dt_s seconds of the axes that are held.
    FlightInput input(double dt_s);

    /// Treats all controls as released; later movements count again.
    void let_go();

    /// True while the next shot button stores a shot.
    bool is_storing() const { return storing_; }

  private:
    struct Held {
        AxisMap map;
        double position = 0;
    };
    void take_axis(const DeckEvent& event);
    void take_button(const DeckEvent& event);

    /// Axes off their rest position, by node and control.
    std::map<std::pair<std::string, std::string>, Held> held_;
    FlightInput input_;
    bool storing_ = false;
};

}  // namespace vantage
