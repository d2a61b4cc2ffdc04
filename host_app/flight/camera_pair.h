#pragma once

#include <cstdint>
#include <optional>

#include "host_app/flight/flight_controller.h"

namespace vantage {

/// The programme's camera and, while hands want one, a second on preview. Hands fly the one on
/// preview then, and the programme's stands, or goes on along its move, until a cut or a flight
/// brings it to what the preview shows. Without a preview hands fly the programme's.
class CameraPair {
  public:
    struct Camera {
        std::uint64_t id;  ///< of none before
        FlightController flight_controller;
        bool follows_performer = false;
    };
    explicit CameraPair(FlightController programme) : programme_{1, std::move(programme)} {}

    Camera& programme() { return programme_; }
    const Camera& programme() const { return programme_; }
    /// Null: there is none.
    const Camera* preview() const { return preview_ ? &*preview_ : nullptr; }
    Camera& in_hand() { return preview_ ? *preview_ : programme_; }
    const Camera& in_hand() const { return preview_ ? *preview_ : programme_; }
    /// Null: it has gone meanwhile.
    Camera* find(std::uint64_t id);
    template <class Visit>
    void for_each_controller(Visit visit) {
        visit(programme_.flight_controller);
        if (preview_) visit(preview_->flight_controller);
    }

    /// The camera on preview begins at the programme's view; hands are back at the programme's
    /// where it ends.
    void toggle_preview();
    // Precondition of both: there is a preview.
    /// Both change places at once, each with what it is on: a move goes on, also to air.
    void cut();
    /// The programme's camera leaves what it is on and flies to the view that the preview has now.
    void fly_to_preview(double duration_s);
    /// 0..1 while it does.
    std::optional<double> fly_progress() const;

    /// Lets dt_s seconds pass.
    void advance(double dt_s);
    /// What hands changed of shots and move. Both cameras have it; one that is on its move on air
    /// flies that as it was until it is off it or in hand.
    std::optional<FlightController::Change> take_change();

  private:
    void share_move();

    Camera programme_;
    std::optional<Camera> preview_;
    std::uint64_t last_id_ = 1;
    bool flies_to_preview_ = false;
    std::optional<std::uint64_t> move_lacking_id_;  ///< the camera that has not the newest move
    FlightBook newest_;
};

}  // namespace vantage
