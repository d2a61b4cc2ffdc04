#pragma once

#include <map>
#include <optional>
#include <string>

#include "common/gl/texture.h"
#include "common/receive/frame_set.h"
#include "host_app/live/depth_colours.h"

namespace vantage {

/// What rigs see, colour and depth, in pictures small enough for a desk. Of the context that is
/// current.
class RigPictures {
  public:
    struct Pictures {
        std::optional<Texture> colour, depth;
        DepthRange range;
    };
    /// Of the rigs that are not in the set the last pictures stay.
    void take(const FrameSet& set);
    /// Null: none yet.
    const Pictures* of(const std::string& rig) const;

  private:
    std::map<std::string, Pictures> pictures_;
};

}  // namespace vantage
