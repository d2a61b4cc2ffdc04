#pragma once

#include <map>
#include <optional>
#include <string>

#include "common/gl/objects/texture.h"
#include "common/receive/frame_set.h"
#include "host_app/desk/feed/depth_colours.h"

namespace vantage {

/// What rigs see, colour, depth and performers, in pictures small enough for a desk. Of the context
/// that is current.
class RigPictures {
  public:
    struct Pictures {
        std::optional<Texture> colour, depth, mask;
        DepthRange range;
    };
    /// Of the rigs that are not in the set the last pictures stay.
    void take(const FrameSet& set);
    /// The performers' share of a rig's picture, 0..255; empty: nothing changes.
    void take_mask(const std::string& rig, const cv::Mat1b& matte);
    /// Null: none yet.
    const Pictures* of(const std::string& rig) const;

  private:
    std::map<std::string, Pictures> pictures_;
};

}  // namespace vantage
