#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "host_app/desk/desk_state.h"
#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// The corridor from above: fields around the camera's pivot, each with what the rigs would cover
/// if the camera stood in its middle. A few fields are worked out at a time, so that nobody waits
/// for all of them.
class CorridorFields {
  public:
    /// Works on, where corridor, pivot, elevation or lens are other than before. `reach_m`: how far
    /// from the pivot fields go.
    void follow(const std::shared_ptr<const Corridor>& corridor, const OrbitView& view,
                double reach_m);

    const std::vector<DeskPlan::Field>& fields() const { return fields_; }
    const Eigen::Vector3d& pivot_m() const { return shown_.pivot_m; }
    double elevation_rad() const { return shown_.elevation_rad; }

  private:
    void begin(const std::shared_ptr<const Corridor>& corridor, const OrbitView& view,
               double reach_m);

    std::shared_ptr<const Corridor> corridor_;
    OrbitView view_, shown_;  ///< of what is worked out, and of what is shown
    std::size_t next_ = 0;
    std::vector<DeskPlan::Field> fields_, coming_;
};

}  // namespace vantage
