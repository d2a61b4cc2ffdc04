#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// Returns the colour of the rig with this number; those of the first eight are easy to tell apart.
cv::Vec3b source_colour(std::size_t rig);
/// Colour of pixels that no rig has seen.
inline constexpr unsigned char source_map_inpainted_colour[3] = {255, 0, 255};
/// Colour of pixels that no rig sees now and one saw before.
inline constexpr unsigned char source_map_remembered_colour[3] = {0, 255, 255};

/// The sources of an image's pixels, as shares of all pixels. They add up to 1.
struct SourceShares {
    std::map<std::string, double> rigs;
    double filled = 0;      ///< seen by no rig
    double remembered = 0;  ///< hidden from all rigs now, seen by one before
};
nlohmann::ordered_json to_json(const SourceShares& shares);
/// Counts the sources of an image. `picture` must be the image that the origins belong to.
SourceShares source_shares(const ColourImage& picture, const PixelOrigins& origins);

/// The source map: an overlay that shows which rig each pixel of the virtual view comes from. Every
/// rig has a colour; the colours are mixed by the rigs' shares and keep the image's brightness.
/// Pixels that no rig sees are hatched. The context that was current at construction must be
/// current at every call.
class SourceMapOverlay {
  public:
    explicit SourceMapOverlay(const ShaderLibrary& library) : pass_(library, "source_map.frag") {}

    /// Gives rigs their colours in the order in which they are first named. They keep them.
    void name_rigs(const std::vector<std::string>& rigs);
    struct Key {
        std::string rig;
        cv::Vec3b colour;
    };
    /// Returns the colours of all rigs that were named.
    const std::vector<Key>& legend() const { return legend_; }

    /// Throws Error if the synthesiser of this name does not report its pixels' sources.
    static void require(bool can_tell, const std::string& name);

    /// Returns the overlaid image, rgba8, in the picture's size and with its alpha; valid until the
    /// next call.
    const Texture& lay(const Texture& picture, const PixelOrigins& origins);

  private:
    cv::Vec3b colour_of(const std::string& rig);

    FullscreenPass pass_;
    DrawnTexture overlaid_{TextureFormat::rgba8, Filter::linear};
    std::vector<Key> legend_;
};

}  // namespace vantage
