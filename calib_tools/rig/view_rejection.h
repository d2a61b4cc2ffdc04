#pragma once

#include <vector>

#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// Board pose that was rejected because its corners contradict the others.
struct RejectedView {
    int board = 0;
    double rms_px = 0, usual_rms_px = 0;
};

/// Rejects, one at a time and worst first, every board whose RMS error exceeds three times the
/// usual one by 0.3 px, and solves again; then rejects corners beyond six sigma (jumped to a
/// neighbour, hidden by a finger). Stops when a third of the boards is rejected. Returns false if a
/// solution fails on the way.
bool reject_bad_views(Bundle& bundle, std::vector<RejectedView>& rejected,
                      std::size_t& corners_left_out);

}  // namespace vantage
