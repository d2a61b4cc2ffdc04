#pragma once

#include <cstdint>
#include <optional>

#include "host_app/flight/flight_controller.h"

namespace vantage {

/// The programme's camera and, if the operator wants one, a second camera on preview. The operator
/// flies the camera on preview while there is one; the programme's camera then holds its pose or
/// goes on along its move. A cut or a flight brings the preview's view on air.
class CameraPair {
  public:
    struct Camera {
        std::uint64_t id;  ///< unique
        FlightController flight_controller;
        bool follows_performer = false;
    };
    explicit CameraPair(FlightController programme) : programme_{1, std::move(programme)} {}

    Camera& programme() { return programme_; }
    const Camera& programme() const { return programme_; }
    /// Null if there is no preview.
    const Camera* preview() const { return preview_ ? &*preview_ : nullptr; }
    /// The camera that the operator flies.
    Camera& in_hand() { return preview_ ? *preview_ : programme_; }
    const Camera& in_hand() const { return preview_ ? *preview_ : programme_; }
    /// Null if the camera was removed.
    Camera* find(std::uint64_t id);
    template <class Visit>
    void for_each_controller(Visit visit) {
        visit(programme_.flight_controller);
        if (preview_) visit(preview_->flight_controller);
    }

    /// Adds a camera on preview at the programme's view, or removes it.
    void toggle_preview();
    // Precondition of both: there is a preview.
    /// Swaps both cameras at once, each with its flight and its move.
    void cut();
    /// The programme's camera leaves its move or flight and flies to the present view of the
    /// preview.
    void fly_to_preview(double duration_s);
    /// Progress 0..1 of that flight.
    std::optional<double> fly_progress() const;

    void advance(double dt_s);
    /// Shots and move, if the operator changed them since the last call. Both cameras take the
    /// change; a camera that is on its move on air takes the new move when it leaves the old one or
    /// is flown by the operator.
    std::optional<FlightController::Change> take_change();

  private:
    void share_move();

    Camera programme_;
    std::optional<Camera> preview_;
    std::uint64_t last_id_ = 1;
    bool flies_to_preview_ = false;
    std::optional<std::uint64_t> move_lacking_id_;  ///< the camera that still has the old move
    FlightBook newest_;
};

}  // namespace vantage
