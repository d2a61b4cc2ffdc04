#include "host_app/flight/camera_pair.h"

#include <cassert>
#include <utility>

namespace vantage {

CameraPair::Camera* CameraPair::find(std::uint64_t id) {
    if (programme_.id == id) return &programme_;
    return preview_ && preview_->id == id ? &*preview_ : nullptr;
}

void CameraPair::toggle_preview() {
    if (preview_) {
        programme_.flight_controller.set_wheel_mode(preview_->flight_controller.wheel_mode());
        preview_.reset();
        share_move();
        return;
    }
    preview_.emplace(Camera{++last_id_, programme_.flight_controller});
    preview_->flight_controller.halt();
}

void CameraPair::cut() {
    assert(preview_);
    const WheelMode mode = preview_->flight_controller.wheel_mode();
    // A flight to the view that is on air now ends where it is.
    if (std::exchange(flies_to_preview_, false)) programme_.flight_controller.halt();
    std::swap(programme_, *preview_);
    share_move();
    preview_->flight_controller.set_wheel_mode(mode);
}

void CameraPair::fly_to_preview(double duration_s) {
    assert(preview_);
    programme_.follows_performer = false;
    programme_.flight_controller.fly_over_to(preview_->flight_controller, duration_s);
    flies_to_preview_ = programme_.flight_controller.flight_progress().has_value();
}

std::optional<double> CameraPair::fly_progress() const {
    return flies_to_preview_ ? programme_.flight_controller.flight_progress() : std::nullopt;
}

void CameraPair::advance(double dt_s) {
    for_each_controller([&](FlightController& each) { each.advance(dt_s); });
    if (!programme_.flight_controller.flight_progress()) flies_to_preview_ = false;
    share_move();
}

std::optional<FlightController::Change> CameraPair::take_change() {
    std::optional<FlightController::Change> change = in_hand().flight_controller.take_change();
    if (!change || !preview_) return change;
    programme_.flight_controller.share({change->book, false});
    if (change->is_of_move || move_lacking_id_) {
        move_lacking_id_ = programme_.id;
        newest_ = change->book;
        share_move();
    }
    return change;
}

void CameraPair::share_move() {
    if (!move_lacking_id_) return;
    Camera* lacking = find(*move_lacking_id_);
    if (lacking && lacking != &in_hand() && lacking->flight_controller.move_progress()) return;
    if (lacking) lacking->flight_controller.share({newest_, true});
    move_lacking_id_.reset();
}

}  // namespace vantage
