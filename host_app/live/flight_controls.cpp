#include "host_app/live/flight_controls.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vantage {

OrbitView FlightControls::step(FlightInput hands, LiveSession& session, double time_s) {
    const double dt_s = time_s - last_s_;
    last_s_ = time_s;
    if (deck_) {
        while (const std::optional<DeckEvent> event = deck_->next()) mapper_.take(*event);
        hands.add(mapper_.input(dt_s));
    }
    if (hands.toggle_freeze) session.set_frozen(!session.frozen());
    if (hands.next_synthesiser) session.next_synthesiser();
    if (hands.toggle_novelty) session.set_novelty(!session.novelty());
    if (hands.to_live) session.to_live();
    double pulses = hands.past_steps;
    if (helm_.wheel_mode() == WheelMode::past)
        pulses += hands.wheel_steps + hands.shuttle_s * session.pulse_rate_hz();
    if (pulses != 0) session.travel(pulses);
    helm_.take(hands, [&](int number) { return rig_view(session, number); });
    helm_.advance(dt_s);
    return helm_.view();
}

std::optional<OrbitView> FlightControls::rig_view(const LiveSession& session, int number) const {
    const FrameSet* set = session.shown();
    const auto index = static_cast<std::size_t>(number - 1);
    if (!set || index >= set->slots.size() || !set->slots[index].frame) return std::nullopt;
    const RigFrame& frame = *set->slots[index].frame;
    const double field_of_view_rad =
        2 * std::atan(0.5 * frame.geometry.width_px / frame.geometry.f_px);
    // The point on the rig's axis that is nearest to the stage's pivot.
    const Eigen::Vector3d eye = frame.world_from_camera.translation();
    const Eigen::Vector3d axis = frame.world_from_camera.linear().col(2);
    const double distance_m = std::max(0.5, axis.dot(pivot_m_ - eye));
    return view_from_eye(eye, eye + distance_m * axis, field_of_view_rad);
}

std::string FlightControls::wheel_line() const {
    if (!deck_) return "";
    std::string names, fault;
    for (const DeckDevice& device : deck_->devices()) {
        if (device.usable)
            names += (names.empty() ? "" : ", ") + device.model;
        else if (!device.fault.empty())
            fault = device.fault;
    }
    if (names.empty()) return fault;
    return fmt::format("{} drives the {}{}", names, name_of(helm_.wheel_mode()),
                       mapper_.is_storing() ? "; the next shot button stores" : "");
}

}  // namespace vantage
