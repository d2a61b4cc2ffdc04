#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// The colour that stands for the rig of this number: distinct for the first eight.
cv::Vec3b source_colour(std::size_t rig);
/// The colour of what no rig has seen.
inline constexpr unsigned char source_map_inpainted_colour[3] = {255, 0, 255};
/// The colour of what a rig has seen before, and none sees now.
inline constexpr unsigned char source_map_remembered_colour[3] = {0, 255, 255};

/// Where the pixels of a picture come from, as shares of all of them; they add up to 1.
struct SourceShares {
    std::map<std::string, double> rigs;
    double filled = 0;      ///< seen by no rig
    double remembered = 0;  ///< seen by a rig before what hides it now came
};
nlohmann::ordered_json to_json(const SourceShares& shares);
/// `picture` is the one that came with the origins.
SourceShares source_shares(const ColourImage& picture, const PixelOrigins& origins);

/// Shows which pixels of the virtual view come from which rig: a colour a rig, mixed by their
/// shares, over the picture's brightness; what no rig sees is hatched. The context that was
/// current at construction must be current at every call.
class SourceMapOverlay {
  public:
    explicit SourceMapOverlay(const ShaderLibrary& library)
        : pass_(library, "source_map.frag") {}

    /// Rigs get their colours in the order in which they are named first, and keep them.
    void name_rigs(const std::vector<std::string>& rigs);
    struct Key {
        std::string rig;
        cv::Vec3b colour;
    };
    /// Of all rigs that were named.
    const std::vector<Key>& legend() const { return legend_; }

    /// Throws Error, with the mend, if the synthesiser of this name cannot tell where its pixels
    /// come from.
    static void require(bool can_tell, const std::string& name);

    /// The result is rgba8 and of the picture's size, alpha as in `picture`; valid until the next
    /// call.
    const Texture& lay(const Texture& picture, const PixelOrigins& origins);

  private:
    cv::Vec3b colour_of(const std::string& rig);

    FullscreenPass pass_;
    DrawnTexture overlaid_{TextureFormat::rgba8, Filter::linear};
    std::vector<Key> legend_;
};

}  // namespace vantage
