#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "calib_tools/board/calibration_boards.h"
#include "calib_tools/stage/stage_calibration.h"

namespace vantage {

/// Where rigs and boards stand before anything is solved together.
struct StageStart {
    std::vector<Pose> world_from_rig;  ///< the world is the first rig's frame
    /// Boards whose places on one body are known: a cube whose faces were never seen together
    /// counts as several bodies.
    struct Body {
        std::string name;
        std::vector<int> boards;  ///< the first one's frame is the body's
    };
    std::vector<Body> bodies;
    std::vector<int> body_of_board;     ///< of every board of the set
    std::vector<Pose> body_from_board;  ///< of every board of the set
    /// rig_from_body by rig, instant and body.
    std::map<std::tuple<std::size_t, long long, int>, Pose> rig_from_body;
};

/// Poses of boards in rigs are edges of a graph; along its strongest edges boards that were seen
/// together join into bodies and rigs that saw one body at one instant are placed, one by one,
/// until nothing is left. Of the two poses that a small board may have, the one that fits all
/// corners of its body in both cameras of the rig counts. Throws Error naming the rigs that nothing
/// ties to the others.
StageStart start_stage(const std::vector<StageRig>& rigs, const CalibrationBoards& boards);

/// The corners of the boards that `wanted` takes.
template <class Wanted>
BoardCorners corners_of(const BoardCorners& corners, const Wanted& wanted) {
    BoardCorners chosen;
    for (const BoardCorner& corner : corners)
        if (wanted(corner.board)) chosen.push_back(corner);
    return chosen;
}

}  // namespace vantage
