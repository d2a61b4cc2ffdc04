#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host_app/surfaces/rig_history.h"

namespace vantage {

/// How long a rig takes to fade in or out.
inline constexpr double fade_s = 1.0 / 6;

/// The rigs of a stage: those that are shown, and those that are away, of which what was learnt is
/// kept until they come back.
class RigRoster {
  public:
    /// Uploads the views of an instant that have depth, filmed `dt_s` after the one before. Rigs
    /// fade instead of popping: one that is missing is shown as it was last seen, less and less;
    /// one that comes takes part more and more. Views of other rigs altogether replace all. Returns
    /// those that were uploaded.
    std::vector<RigHistory*> upload(std::span<const DepthView> views, double dt_s);
    /// What was shown is not shown any more, also not of rigs that fade.
    void cut();
    /// Nothing that was learnt is of use any more.
    void forget();

    /// Those of the last upload, and those that fade.
    const std::vector<RigHistory*>& shown() const { return shown_; }
    /// Those that are away too.
    std::vector<RigHistory*> known() const;
    /// Whether it is one of them, and its set was learnt.
    bool has_learnt(const RigHistory* rig) const;

  private:
    std::vector<std::unique_ptr<RigHistory>> rigs_;
    std::vector<RigHistory*> shown_;
};

}  // namespace vantage
