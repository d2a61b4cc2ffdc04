#pragma once

#include <vector>

#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// A board's pose that was thrown out because its corners contradict the rest.
struct RejectedView {
    int board = 0;
    double rms_px = 0, usual_rms_px = 0;
};

/// Throws out, one at a time and the worst first, every board whose corners miss the model by more
/// than three times what is usual and by 0.3 px more, and solves again; then corners beyond six
/// sigma (jumped to a neighbour, hidden by a finger). Stops when a third of the boards is gone.
/// Returns false if a solution is lost on the way.
bool reject_bad_views(Bundle& bundle, std::vector<RejectedView>& rejected,
                      std::size_t& corners_left_out);

}  // namespace vantage
