#include "host_app/flight/flight_input.h"

#include <algorithm>

namespace vantage {
namespace {

constexpr double FlightInput::*camera_axes[] = {&FlightInput::orbit_azimuth_rad,
                                                &FlightInput::orbit_elevation_rad,
                                                &FlightInput::pan_right_widths,
                                                &FlightInput::pan_up_widths,
                                                &FlightInput::dolly,
                                                &FlightInput::zoom,
                                                &FlightInput::crane_up_widths,
                                                &FlightInput::look_right_rad,
                                                &FlightInput::look_up_rad,
                                                &FlightInput::roll_rad};
constexpr double FlightInput::*other_axes[] = {&FlightInput::retime_s, &FlightInput::wheel_steps,
                                               &FlightInput::shuttle_s};

template <class Axes>
bool is_any_moved(const FlightInput& input, const Axes& axes) {
    return std::any_of(std::begin(axes), std::end(axes),
                       [&](const auto axis) { return input.*axis != 0; });
}

}  // namespace

bool FlightInput::turns_camera() const { return is_any_moved(*this, camera_axes); }

bool FlightInput::steers() const {
    return turns_camera() || find<command::LookAt>() || find<command::ResetView>() ||
           find<command::RecallShot>();
}

bool FlightInput::moves_pivot() const {
    return pan_right_widths != 0 || pan_up_widths != 0 || crane_up_widths != 0 ||
           look_right_rad != 0 || look_up_rad != 0 || find<command::LookAt>() ||
           find<command::ResetView>() || find<command::RecallShot>();
}

bool FlightInput::is_any() const {
    return !commands.empty() || turns_camera() || is_any_moved(*this, other_axes);
}

void FlightInput::add(const FlightInput& other) {
    add_axes(other);
    commands.insert(commands.end(), other.commands.begin(), other.commands.end());
}

void FlightInput::add_axes(const FlightInput& other) {
    for (const auto axis : camera_axes) this->*axis += other.*axis;
    for (const auto axis : other_axes) this->*axis += other.*axis;
}

}  // namespace vantage
