#pragma once

#include <array>
#include <optional>

#include "common/gl/objects/texture.h"
#include "host_app/control/flight_controls.h"
#include "host_app/programme/picture_maker.h"

namespace vantage {

/// What the shots that were kept look like: the programme's picture when it was there last, small.
/// Of the context that is current.
class ShotPictures {
  public:
    void follow(const FlightControls::Shots& shots, const MadePicture& picture, MonotonicTime now);
    /// Of shot 1, 2, ...; null: it was not flown to since it was kept.
    const Texture* of(std::size_t number) const;

  private:
    struct Place {
        OrbitView view;
        std::optional<Texture> picture;
        MonotonicTime taken{};
    };
    std::array<std::optional<Place>, std::tuple_size_v<FlightControls::Shots>> places_;
};

}  // namespace vantage
