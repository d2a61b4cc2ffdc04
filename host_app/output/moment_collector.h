#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/image/image.h"
#include "common/receive/frame_set.h"

namespace vantage {

/// Image of the virtual camera and its frame set at one moment of a flight.
struct Moment {
    std::string title;
    ColourImage picture;                  ///< of the virtual camera
    std::shared_ptr<const FrameSet> set;  ///< the frame set that it was rendered from
};

/// Selects moments evenly over a flight of unknown length in bounded memory: it keeps every frame,
/// then every 2nd, every 4th and so on.
class MomentCollector {
  public:
    /// Precondition: wanted >= 2.
    explicit MomentCollector(std::size_t wanted) : wanted_(wanted) {}

    /// Frames count from 0.
    bool wants(std::uint64_t picture) const { return picture % stride_ == 0; }
    /// Precondition: wants(picture) is true, and all earlier wanted frames were added.
    void add(Moment moment);

    /// At most `wanted` moments, evenly spaced, including the first and the newest one kept.
    std::vector<Moment> chosen() const;

  private:
    std::size_t wanted_;
    std::uint64_t stride_ = 1;
    std::vector<Moment> kept_;
};

}  // namespace vantage
