#pragma once

#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "calib_tools/board/calibration_boards.h"
#include "calib_tools/rig/rig_calibration.h"
#include "calib_tools/stage/next_picture.h"
#include "common/config/calibration_file.h"

namespace vantage {

/// What one rig brings to the calibration of a stage.
struct StageRig {
    std::string name;
    StereoCalibration calibration;
    /// Board sightings by instant; the same number is the same instant at every rig.
    std::map<long long, BoardCorners> left, right;
    /// What the rig's own calibration knows of itself; without it lenses and baseline are held.
    std::optional<CalibrationSigma> sigma;
    double alpha = 0;  ///< of its rectification, which follows the refined lenses
};

struct StageCalibration {
    struct Rig {
        std::string name;
        StereoCalibration calibration;  ///< with world_from_left
        /// 1 sigma, relative to the first rig (whose own are 0): the length over the three axes.
        double translation_sigma_m = 0, rotation_sigma_rad = 0;
        double rotation_sigma_deg() const { return 180 / std::numbers::pi * rotation_sigma_rad; }
        double rms_px = 0;
        int instants = 0;         ///< in which it saw the board
        bool refined = false;     ///< lenses and baseline too, in `calibration`
        double focal_change = 0;  ///< largest relative change of a focal length by that
        double baseline_change_m = 0;
        std::optional<CalibrationSigma> sigma;  ///< after it
    };
    /// Instants that two rigs saw together.
    struct Tie {
        std::size_t a = 0, b = 0;
        int shared = 0;
    };
    std::vector<Rig> rigs;
    std::vector<Tie> ties;
    std::vector<Refusal> rejected;            ///< instants
    std::vector<std::string> advice;          ///< weakly tied rigs and the picture that would help
    std::optional<NextPicture> next_picture;  ///< that would help most
    double rms_px = 0;
    std::size_t instants_given = 0;  ///< at which a board was seen anew
    std::size_t instants_used = 0;
    bool has_floor = false;
    /// What was carried about as one, as far as the pictures tell: the boards of the set that it
    /// is made of, and of several where they turned out to be on it (the first gives the frame).
    struct Body {
        std::string name;
        std::vector<int> boards;
        std::vector<Pose> body_from_board;
        std::vector<double> translation_sigma_m;  ///< against the first
    };
    std::vector<Body> bodies;
    /// Of a board of the bundle: which body it is, and when.
    struct Placement {
        long long instant = 0;
        int body = 0;
    };
    std::vector<Placement> placements;
    std::string placement_name(int board) const;  ///< "instant 7, cube"
    Bundle bundle;  ///< cameras 2i and 2i + 1 are the left and right one of rig i
    static constexpr int few_shared = 5;  ///< instants; a tie of fewer is weak
};

/// The picture that says where the world's floor is.
struct Floor {
    long long instant = 0;
    std::string board;  ///< its name, where several flat ones are seen; empty: the only one

    Floor(long long at, std::string name = {})  // NOLINT(google-explicit-constructor)
        : instant(at), board(std::move(name)) {}
};

/// The extrinsics of all rigs: poses of the boards in each rig give a graph whose edges are
/// instants that two rigs saw; along its strongest edges the rigs are placed, then rigs, boards and
/// the places of boards on their bodies are solved together. Lenses and baselines of a rig whose
/// uncertainties are known are solved as well, held to their own calibration as firmly as that was
/// certain, so that the uncertainties stated include theirs; those of other rigs are held. What
/// boards that lie still show again and again counts once (without_repeats). With
/// `floor` the flat board of that instant lies on the floor: the world's origin is its middle, y
/// up, x along its rows, z along its columns. Without, the first rig is taken to stand level
/// (assume_place). Throws Error naming rigs that no board ties to the others, boards that look
/// alike when turned, boards that cannot be told apart, and a floor board nobody saw.
StageCalibration calibrate_stage(const std::vector<StageRig>& rigs, const CalibrationBoards& boards,
                                 const std::optional<Floor>& floor);

}  // namespace vantage
