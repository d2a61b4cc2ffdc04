#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/image/image.h"
#include "common/receive/frame_set.h"

namespace vantage {

/// What was seen at one moment of a flight.
struct Moment {
    std::string title;
    ColourImage picture;                  ///< of the virtual camera
    std::shared_ptr<const FrameSet> set;  ///< that it was made from
};

/// Picks moments evenly over a flight whose length nobody knows yet, within bounded memory: it
/// keeps every 1st, then every 2nd, every 4th ... picture.
class MomentCollector {
  public:
    /// Precondition: wanted >= 2.
    explicit MomentCollector(std::size_t wanted) : wanted_(wanted) {}

    /// Pictures are counted from 0.
    bool wants(std::uint64_t picture) const { return picture % stride_ == 0; }
    /// Precondition: wants(picture), and all wanted ones before it were added.
    void add(Moment moment);

    /// At most `wanted` moments, evenly spread, the first and the newest one kept included.
    std::vector<Moment> chosen() const;

  private:
    std::size_t wanted_;
    std::uint64_t stride_ = 1;
    std::vector<Moment> kept_;
};

}  // namespace vantage
