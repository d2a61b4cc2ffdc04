#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "common/gl/objects/texture.h"
#include "common/image/image.h"
#include "common/receive/frame_set.h"
#include "host_app/control/flight_controls.h"
#include "host_app/programme/picture_maker.h"
#include "host_app/replay/clip.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Converts disparities to depths in metres; 0 is unknown.
DepthImage depth_of(const DisparityImage& disparity, const DisparityScale& scale);

/// The range of depths that a false-colour picture shows: the scene without its nearest and
/// farthest 2 %. It changes slowly, so that a colour keeps its meaning between pictures.
struct DepthRange {
    double nearest_m = 0, farthest_m = 0;  ///< 0: unknown

    void follow(const DepthImage& depth);
};

/// Paints depths in the cividis palette, which readers with impaired colour vision see alike
/// (J. Nuñez, C. Anderton, R. Renslow, 2018): yellow is nearest, dark blue is farthest, linear in
/// the logarithm of depth. Unknown depths are black.
ColourImage depth_colours(const DepthImage& depth, const DepthRange& range);

/// Small pictures of each rig's colour, depth and foreground for the desk. The textures belong to
/// the context that is current.
class RigPictures {
  public:
    struct Pictures {
        std::optional<Texture> colour, depth, mask;
        DepthRange range;
    };
    /// Takes the pictures of a frame set. Rigs that are not in it keep their last pictures.
    void take(const FrameSet& set);
    /// Takes a rig's matte, 0..255; an empty one changes nothing.
    void take_mask(const std::string& rig, const cv::Mat1b& matte);
    /// Returns a rig's pictures, or null if there are none yet.
    const Pictures* of(const std::string& rig) const;

  private:
    std::map<std::string, Pictures> pictures_;
};

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
