#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "calib_tools/stage/stage_calibration.h"
#include "common/board/calibration_boards.h"

namespace vantage {

/// Initial poses of rigs and boards for the joint solution.
struct StageStart {
    std::vector<Pose> world_from_rig;  ///< the world is the first rig's frame
    /// Boards with known relative poses. A cube whose faces were never seen together counts as
    /// several bodies.
    struct Body {
        std::string name;
        std::vector<int> boards;  ///< the first one's frame is the frame of the body
    };
    std::vector<Body> bodies;
    std::vector<int> body_of_board;     ///< of every board in the list
    std::vector<Pose> body_from_board;  ///< of every board in the list
    /// rig_from_body by rig, frame set and body.
    std::map<std::tuple<std::size_t, long long, int>, Pose> rig_from_body;
};

/// Places rigs and boards one after another. Poses of boards in rigs are edges of a graph; along
/// its strongest edges, boards that were seen together join into bodies, and rigs that saw one body
/// in one frame set are placed. Of the two poses that a small board may have, the one that fits all
/// corners of its body in both cameras is used. Throws Error with the rigs that nothing connects to
/// the others.
StageStart start_stage(const std::vector<StageRig>& rigs, const CalibrationBoards& boards);

/// The corners of the boards that `wanted` accepts.
template <class Wanted>
BoardCorners corners_of(const BoardCorners& corners, const Wanted& wanted) {
    BoardCorners chosen;
    for (const BoardCorner& corner : corners)
        if (wanted(corner.board)) chosen.push_back(corner);
    return chosen;
}

}  // namespace vantage
