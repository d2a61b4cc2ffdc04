#include "host_app/flight/flight_input.h"

namespace vantage {

void FlightInput::add(const FlightInput& other) {
    orbit_azimuth_rad += other.orbit_azimuth_rad;
    orbit_elevation_rad += other.orbit_elevation_rad;
    pan_right_widths += other.pan_right_widths;
    pan_up_widths += other.pan_up_widths;
    dolly += other.dolly;
    zoom += other.zoom;
    crane_up_widths += other.crane_up_widths;
    look_right_rad += other.look_right_rad;
    look_up_rad += other.look_up_rad;
    roll_rad += other.roll_rad;
    if (other.pick) pick = other.pick;
    if (other.pivot_m) pivot_m = other.pivot_m;
    toggle_horizon ^= other.toggle_horizon;
    toggle_follow ^= other.toggle_follow;
    wheel_steps += other.wheel_steps;
    shuttle_s += other.shuttle_s;
    // Two presses of a switch undo each other.
    toggle_freeze ^= other.toggle_freeze;
    toggle_move ^= other.toggle_move;
    toggle_source_map ^= other.toggle_source_map;
    toggle_take ^= other.toggle_take;
    toggle_tracking ^= other.toggle_tracking;
    toggle_jog_map ^= other.toggle_jog_map;
    toggle_recording ^= other.toggle_recording;
    toggle_preview ^= other.toggle_preview;
    cut |= other.cut;
    fly_to_preview |= other.fly_to_preview;
    if (other.fly_to_preview_tenths != 0) fly_to_preview_tenths = other.fly_to_preview_tenths;
    add_keyframe |= other.add_keyframe;
    set_keyframe |= other.set_keyframe;
    remove_keyframe |= other.remove_keyframe;
    keyframe_jump += other.keyframe_jump;
    retime_s += other.retime_s;
    save_background |= other.save_background;
    learn_background |= other.learn_background;
    reset |= other.reset;
    next_synthesiser |= other.next_synthesiser;
    to_live |= other.to_live;
    past_steps += other.past_steps;
    speed_steps += other.speed_steps;
    mark_in |= other.mark_in;
    mark_out |= other.mark_out;
    clear_marks |= other.clear_marks;
    toggle_loop ^= other.toggle_loop;
    cue |= other.cue;
    replay.insert(replay.end(), other.replay.begin(), other.replay.end());
    if (!other.cue_time.empty()) cue_time = other.cue_time;
    next_wheel_mode |= other.next_wheel_mode;
    if (other.recall_shot != 0) recall_shot = other.recall_shot;
    if (other.toggle_output != 0) toggle_output = other.toggle_output;
    if (other.store_shot != 0) store_shot = other.store_shot;
}

bool FlightInput::commands_twice(const FlightInput& other) const {
    const auto both = [&](auto FlightInput::*what) { return this->*what != 0 && other.*what != 0; };
    return both(&FlightInput::toggle_freeze) || both(&FlightInput::toggle_move) ||
           both(&FlightInput::toggle_source_map) || both(&FlightInput::toggle_take) ||
           both(&FlightInput::save_background) || both(&FlightInput::learn_background) ||
           both(&FlightInput::toggle_tracking) || both(&FlightInput::toggle_jog_map) ||
           both(&FlightInput::toggle_loop) || both(&FlightInput::reset) ||
           both(&FlightInput::next_synthesiser) || both(&FlightInput::next_wheel_mode) ||
           both(&FlightInput::to_live) || both(&FlightInput::mark_in) ||
           both(&FlightInput::mark_out) || both(&FlightInput::clear_marks) ||
           both(&FlightInput::cue) || both(&FlightInput::recall_shot) ||
           both(&FlightInput::store_shot) || both(&FlightInput::toggle_output) ||
           both(&FlightInput::toggle_recording) || both(&FlightInput::add_keyframe) ||
           both(&FlightInput::set_keyframe) || both(&FlightInput::remove_keyframe) ||
           both(&FlightInput::toggle_horizon) || both(&FlightInput::toggle_follow) ||
           (commands_preview() && other.commands_preview()) ||
           ((!replay.empty() || !cue_time.empty()) && other.commands_time());
}

FlightInput FlightInput::turns() const {
    FlightInput turns;
    for (const auto what : {&FlightInput::orbit_azimuth_rad, &FlightInput::orbit_elevation_rad,
                            &FlightInput::pan_right_widths, &FlightInput::pan_up_widths,
                            &FlightInput::crane_up_widths, &FlightInput::look_right_rad,
                            &FlightInput::look_up_rad, &FlightInput::roll_rad, &FlightInput::dolly,
                            &FlightInput::zoom, &FlightInput::wheel_steps, &FlightInput::shuttle_s,
                            &FlightInput::past_steps, &FlightInput::retime_s})
        turns.*what = this->*what;
    return turns;
}

}  // namespace vantage
