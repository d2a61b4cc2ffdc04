#pragma once

#include <memory>
#include <vector>

#include "host_app/background/background.h"

namespace vantage {

/// What a preparer of instants has learnt of the stage's set, as a thing of its own. Belongs to the
/// preparer's thread and context.
class BackgroundAccess {
  public:
    virtual ~BackgroundAccess() = default;

    /// Rigs that have no past, now and later, begin with what this set has of them, if it was
    /// learnt with their calibration; states() tells of those that it does not fit. Null: with
    /// nothing.
    virtual void begin_with(std::shared_ptr<const Background> set) = 0;
    /// What the rigs see from now on is the set, whatever was known: for a stage that is empty.
    virtual void learn_anew() = 0;
    /// Reads all of it back. Waits for the GPU.
    virtual Background learnt() const = 0;
    /// Of the rigs of the newest instant, a second old at most.
    virtual std::vector<RigBackgroundState> states() const = 0;
};

}  // namespace vantage
