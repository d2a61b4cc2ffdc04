#pragma once

#include <map>
#include <optional>
#include <string>

#include "common/gl/objects/texture.h"
#include "common/image/image.h"
#include "common/receive/frame_set.h"
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

}  // namespace vantage
