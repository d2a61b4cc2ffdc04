#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host_app/surfaces/rig_history.h"

namespace vantage {

/// Time in which a rig fades in or out, s: short, but no visible jump.
inline constexpr double fade_s = 1.0 / 6;

/// The rigs of a stage, by name. A rig that disappears keeps its background until it comes back.
/// Belongs to the preparer's thread and GL context.
class RigRoster {
  public:
    /// Uploads the views of an instant that have depth, filmed `dt_s` after the one before, and
    /// returns their rigs. A rig that appears fades in; a rig that is missing fades out with its
    /// last surfaces. If no view belongs to a known rig, all rigs are replaced.
    std::vector<RigHistory*> upload(std::span<const DepthView> views, double dt_s);
    /// Hides all rigs at once, also those that are fading.
    void cut();
    /// Forgets all that was learnt of all rigs.
    void forget();

    /// The rigs of the last upload and those that are fading out.
    const std::vector<RigHistory*>& shown() const { return shown_; }
    /// All rigs, also those that are away.
    std::vector<RigHistory*> known() const;
    /// Whether `rig` is one of them and has a background.
    bool has_learnt(const RigHistory* rig) const;

  private:
    std::vector<std::unique_ptr<RigHistory>> rigs_;
    std::vector<RigHistory*> shown_;
};

}  // namespace vantage
