#pragma once

#include <deque>
#include <map>
#include <optional>

#include "common/gl/objects/texture.h"
#include "host_app/programme/picture_maker.h"
#include "host_app/replay/clip.h"

namespace vantage {

/// What clips look like: a picture that the programme showed of a moment in them, small, the
/// nearest to their beginning of the last minutes', or the first that comes. Of the context that is
/// current.
class ClipPictures {
  public:
    void follow(const ClipBook& book, const MadePicture& picture, MonotonicTime now);
    /// Null: nothing of that clip was shown yet.
    const Texture* of(int number) const;

  private:
    struct Passed {
        std::uint64_t pulse = 0;
        ColourImage picture;
    };
    struct Place {
        std::uint64_t in = 0, out = 0;  ///< of the clip that it is of
        std::optional<Texture> picture;
    };
    std::deque<Passed> passed_;  ///< the latest last
    MonotonicTime taken_{};
    std::map<int, Place> places_;
};

}  // namespace vantage
