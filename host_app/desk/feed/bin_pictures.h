#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>

#include "common/gl/objects/texture.h"
#include "host_app/control/flight_controls.h"
#include "host_app/programme/picture_maker.h"
#include "host_app/replay/clip.h"

namespace vantage {

// Thumbnails for the bins of the desk. The textures belong to the context that is current.

/// The thumbnails of clips. Each shows the programme's picture nearest to the clip's beginning from
/// the last two minutes, or the next one from within the clip.
class ClipPictures {
  public:
    void follow(const ClipBook& book, const MadePicture& picture, MonotonicTime now);
    /// Returns the clip's thumbnail, or null if no picture from it was shown yet.
    const Texture* of(int number) const;

  private:
    struct Passed {
        std::uint64_t pulse = 0;
        ColourImage picture;
    };
    struct Place {
        std::uint64_t in = 0, out = 0;  ///< marks of the clip that the thumbnail belongs to
        std::optional<Texture> picture;
    };
    std::deque<Passed> passed_;  ///< latest last
    MonotonicTime taken_{};
    std::map<int, Place> places_;
};

/// The thumbnails of stored shots: the programme's latest picture from each shot's view.
class ShotPictures {
  public:
    void follow(const FlightControls::Shots& shots, const MadePicture& picture, MonotonicTime now);
    /// Returns the thumbnail of shot 1, 2, ..., or null if the camera has not been there since the
    /// shot was stored.
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
