#pragma once

#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "calib_tools/rig/rig_calibration.h"
#include "calib_tools/stage/next_picture.h"
#include "common/board/calibration_boards.h"
#include "common/config/calibration_file.h"

namespace vantage {

/// Input of one rig for the calibration of a stage.
struct StageRig {
    std::string name;
    StereoCalibration calibration;
    /// Board sightings by frame set; equal numbers are the same frame set at all rigs.
    std::map<long long, BoardCorners> left, right;
    /// Uncertainties from the rig's own calibration; without them lenses and baseline are held
    /// fixed.
    std::optional<CalibrationSigma> sigma;
    double alpha = 0;  ///< of its rectification, which is computed again for the refined lenses
};

struct StageCalibration {
    struct Rig {
        std::string name;
        StereoCalibration calibration;  ///< with world_from_left
        /// Standard deviations relative to the first rig, whose own are 0: the length over the
        /// three axes.
        double translation_sigma_m = 0, rotation_sigma_rad = 0;
        double rotation_sigma_deg() const { return 180 / std::numbers::pi * rotation_sigma_rad; }
        double rms_px = 0;
        int instants = 0;         ///< number of frame sets with the board
        bool refined = false;     ///< lenses and baseline in `calibration` were refined too
        double focal_change = 0;  ///< largest relative change of a focal length in the refinement
        double baseline_change_m = 0;
        std::optional<CalibrationSigma> sigma;  ///< after the refinement
    };
    /// Number of frame sets that connect two rigs.
    struct Tie {
        std::size_t a = 0, b = 0;
        int shared = 0;
    };
    std::vector<Rig> rigs;
    std::vector<Tie> ties;
    std::vector<Refusal> rejected;    ///< rejected frame sets
    std::vector<std::string> advice;  ///< weakly connected rigs, and the image that would help
    std::optional<NextPicture> next_picture;  ///< next image that would help most
    double rms_px = 0;
    std::size_t instants_given = 0;  ///< frame sets with a new sighting of a board
    std::size_t instants_used = 0;
    bool has_floor = false;
    /// Rigid body, as far as the images show it: its boards and, for several boards, their poses on
    /// it. The first board defines its frame.
    struct Body {
        std::string name;
        std::vector<int> boards;
        std::vector<Pose> body_from_board;
        std::vector<double> translation_sigma_m;  ///< relative to the first board
    };
    std::vector<Body> bodies;
    /// Body and frame set of a board in the bundle.
    struct Placement {
        long long instant = 0;
        int body = 0;
    };
    std::vector<Placement> placements;
    std::string placement_name(int board) const;  ///< "instant 7, cube"
    Bundle bundle;  ///< cameras 2i and 2i + 1 are the left and right camera of rig i
    static constexpr int few_shared = 5;  ///< a connection of fewer frame sets is weak
};

/// Frame set that shows the board on the floor.
struct Floor {
    long long instant = 0;
    std::string board;  ///< name of the board if several flat ones are visible; empty: the only one

    Floor(long long at, std::string name = {})  // NOLINT(google-explicit-constructor)
        : instant(at), board(std::move(name)) {}
};

/// Calibrates the poses of all rigs. The poses of boards in each rig form a graph whose edges are
/// frame sets that two rigs saw. The rigs are placed along its strongest edges; then rigs, boards
/// and the boards' poses on their bodies are solved together. Lenses and baselines of a rig with
/// known uncertainties are solved too, with its own calibration as a prior, so that the stated
/// uncertainties include theirs; those of other rigs are held fixed. Repeated sightings of boards
/// at rest count once (without_repeats).
/// With `floor`, the flat board of that frame set lies on the floor: the world's origin is its
/// centre, y up, x along its rows, z along its columns. Without it, the first rig is assumed level
/// (assume_place).
/// Throws Error for rigs that no board connects to the others, boards that look the same when
/// turned, boards that cannot be distinguished, and a floor board that nobody saw.
StageCalibration calibrate_stage(const std::vector<StageRig>& rigs, const CalibrationBoards& boards,
                                 const std::optional<Floor>& floor);

}  // namespace vantage
