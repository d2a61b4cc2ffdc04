#include "host_app/desk/desk_state.h"

#include <algorithm>

namespace vantage {

double DeskTime::share_of(double pulse) const {
    return std::clamp((pulse - oldest) / std::max(1.0, newest - oldest), 0.0, 1.0);
}

double DeskTime::pulse_at(double share) const {
    return oldest + std::clamp(share, 0.0, 1.0) * (newest - oldest);
}

}  // namespace vantage
