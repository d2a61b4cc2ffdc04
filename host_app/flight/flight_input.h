#pragma once

namespace vantage {

/// What the operator's hands did since the last look, whatever they held. Angles in radians, shifts
/// in picture widths, dolly and zoom in powers of e (see OrbitCamera).
struct FlightInput {
    double orbit_azimuth_rad = 0, orbit_elevation_rad = 0;
    double pan_right_widths = 0, pan_up_widths = 0;
    double dolly = 0, zoom = 0;
    bool toggle_freeze = false, reset = false, next_synthesiser = false, toggle_move = false;
    bool toggle_tracking = false;
    bool next_wheel_mode = false, to_live = false, toggle_novelty = false, toggle_take = false;
    bool save_set = false, learn_set = false;
    bool mark_in = false, mark_out = false, clear_marks = false, toggle_loop = false, cue = false;
    int speed_steps = 0;                  ///< to faster or slower playing of the past
    int recall_shot = 0, store_shot = 0;  ///< 1..9; 0: none
    int toggle_output = 0;                ///< 1..8; 0: none

    /// Detents of a jog wheel, clockwise positive.
    double wheel_steps = 0;
    /// What a shuttle ring asks for: seconds of normal speed in this look's time, so at 2x speed
    /// twice its length.
    double shuttle_s = 0;

    /// Frames back (negative) or on, through the past.
    double past_steps = 0;

    /// True if the operator has the camera itself in hand.
    bool steers() const {
        return orbit_azimuth_rad != 0 || orbit_elevation_rad != 0 || pan_right_widths != 0 ||
               pan_up_widths != 0 || dolly != 0 || zoom != 0 || reset || recall_shot != 0;
    }
    /// True if there is anything in it.
    bool is_any() const {
        return steers() || turns_wheel() || toggle_freeze || next_synthesiser || toggle_move ||
               next_wheel_mode || to_live || toggle_novelty || store_shot != 0 || past_steps != 0 ||
               toggle_tracking || toggle_take || save_set || learn_set || toggle_output != 0 ||
               mark_in || mark_out || clear_marks || toggle_loop || cue || speed_steps != 0;
    }
    /// Whether the same thing is commanded in both, so that one of them would be lost in add().
    bool commands_twice(const FlightInput& other) const;
    /// Without its commands: what it turns and shifts.
    FlightInput turns() const;
    bool turns_wheel() const { return wheel_steps != 0 || shuttle_s != 0; }

    /// Both hands together.
    void add(const FlightInput& other);
};

}  // namespace vantage
