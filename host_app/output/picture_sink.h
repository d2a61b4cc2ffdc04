#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/av/sound.h"
#include "common/image/image.h"
#include "common/receive/frame_set.h"
#include "host_app/flight/camera_state.h"

namespace vantage {

/// What a tick hands out. Pictures and sets are shared and never change.
struct ProgrammePicture {
    std::uint64_t tick = 0;  ///< from the first picture on; none is left out
    ColourImage picture;     ///< clean
    ColourImage overlaid;    ///< for people: with the source map where that is asked for
    std::shared_ptr<const FrameSet> set;
    CameraState camera;                       ///< that the picture was rendered from
    std::string title;                        ///< one line for people: when, of what, from where
    std::shared_ptr<const SoundBlock> sound;  ///< of the tick; null: the programme has none
};

/// Where the programme's pictures go. One that fails is closed and reported; neither the programme
/// nor another sink notices.
class PictureSink {
  public:
    virtual ~PictureSink() = default;
    /// Name for people; empty: the sink is no output of the programme and has no stats among them.
    virtual std::string name() const = 0;
    /// Never waits: what cannot be taken now is left out and counted. Throws Error if the sink has
    /// failed.
    virtual void take(const ProgrammePicture& picture) = 0;
    /// Ends it: what waits is written. Throws Error if the sink has failed.
    virtual void finish() {}
};

}  // namespace vantage
