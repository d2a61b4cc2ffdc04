#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "host_app/desk/desk_state.h"
#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// The map of the corridor from above: fields around the camera's pivot, each with the coverage
/// that a camera in its middle would have. A few fields are computed per call, so that the desk
/// never waits for the whole map.
class CorridorFields {
  public:
    /// Computes some more fields, and starts again if corridor, pivot, elevation or field of view
    /// have changed. `reach_m` is the radius of the map.
    void follow(const std::shared_ptr<const Corridor>& corridor, const OrbitView& view,
                double reach_m);

    const std::vector<DeskPlan::Field>& fields() const { return fields_; }
    const Eigen::Vector3d& pivot_m() const { return shown_.pivot_m; }
    double elevation_rad() const { return shown_.elevation_rad; }

  private:
    void begin(const std::shared_ptr<const Corridor>& corridor, const OrbitView& view,
               double reach_m);

    std::shared_ptr<const Corridor> corridor_;
    OrbitView view_, shown_;  ///< of the map that is computed, and of the finished one
    std::size_t next_ = 0;
    std::vector<DeskPlan::Field> fields_, coming_;
};

}  // namespace vantage
