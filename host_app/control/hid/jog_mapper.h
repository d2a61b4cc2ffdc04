#pragma once

#include <map>
#include <string>

#include "host_app/control/hid/jog_devices.h"
#include "host_app/flight/flight_input.h"

namespace vantage {

/// Speed that a shuttle ring stands for, as operators know it: 0, 0.1, 0.25, 0.33, 0.5, 0.75, 1, 2
/// over its way of 0 to 1, straight in between; negative backwards.
double shuttle_speed(double position);

/// From what happens at the desk to what the flight is asked to do, by the profiles of the wheels.
class JogMapper {
  public:
    void take(const DeckEvent& event);

    /// All that was asked for since the last call, and what held axes ask for in dt_s seconds.
    FlightInput input(double dt_s);

    /// Nothing is held any more, be it held or not: what is moved next counts.
    void let_go();

    /// Whether the next shot button stores.
    bool is_storing() const { return storing_; }

  private:
    struct Held {
        AxisMap map;
        double position = 0;
    };
    void take_axis(const DeckEvent& event);
    void take_button(const DeckEvent& event);

    /// By node and control, of every axis that is off its rest.
    std::map<std::pair<std::string, std::string>, Held> held_;
    FlightInput input_;
    bool storing_ = false;
};

}  // namespace vantage
