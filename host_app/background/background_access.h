#pragma once

#include <memory>
#include <vector>

#include "host_app/background/background.h"

namespace vantage {

/// Access to the background that a preparer of instants learns. Belongs to the preparer's thread
/// and GL context.
class BackgroundAccess {
  public:
    virtual ~BackgroundAccess() = default;

    /// Rigs without a history, present and future ones, begin with their part of this background if
    /// their calibration is the one that it was learnt with; states() reports those that it does
    /// not fit. Null: they begin without.
    virtual void begin_with(std::shared_ptr<const Background> background) = 0;
    /// Forgets the background and learns it again from the next instants: for an empty stage.
    virtual void learn_anew() = 0;
    /// Reads the background back. Waits for the GPU.
    virtual Background learnt() const = 0;
    /// The states of the newest instant's rigs, at most a second old.
    virtual std::vector<RigBackgroundState> states() const = 0;
};

}  // namespace vantage
