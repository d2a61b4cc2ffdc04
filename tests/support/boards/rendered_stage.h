#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/geometry/stereo_calibration.h"
#include "tests/support/boards/rendered_board.h"

namespace vantage {

/// The poses body_from_board of boards on a cube whose frame is at its middle with y up. The first
/// four are around it, the fifth on top; each board with its margin fills its face.
std::vector<Pose> cube_faces(const BoardPattern& face);

/// Two ChArUco boards of 5x4 corners without common markers: for the floor, and to be carried.
std::vector<BoardPattern> floor_and_hand_board();

/// Four rigs on an arc of 120 degrees, 4 m from the middle of a stage, each with two lenses of its
/// own, and the poses of boards that an assistant holds.
class RenderedStage {
  public:
    static constexpr int rig_count = 4;

    RenderedStage(const BoardPattern& pattern, int width_px, std::uint64_t seed)
        : RenderedStage(std::vector{pattern}, width_px, seed) {}
    /// With several boards of one size.
    RenderedStage(const std::vector<BoardPattern>& patterns, int width_px, std::uint64_t seed);

    /// True lenses, relative pose and world_from_left.
    const StereoCalibration& truth(int rig) const { return truths_[static_cast<std::size_t>(rig)]; }
    static std::string name(int rig) { return std::string(1, static_cast<char>('A' + rig)); }

    /// A tilted board near a rig, in turn in every part of its image: left_from_board.
    Pose board_near_rig(int rig);
    /// A board in the overlap of rig `pair` and the next one, 1.5 to 4 m from both:
    /// world_from_board.
    Pose board_before_pair(int pair);
    /// The board on the floor, face up, which defines the world: world_from_board.
    Pose board_on_floor() const;
    /// A wand at random poses around the middle of the stage: world_from_body.
    Pose wand_in_the_middle();

    /// Renders a board at a pose in the world, as a rig's left (0) or right (1) camera sees it.
    GreyImage film(int rig, int side, const Pose& world_from_board, const PictureFaults& faults);
    /// A board's index and its pose world_from_board.
    struct StandingBoard {
        std::size_t board = 0;
        Pose world_from_board = Pose::Identity();
    };
    GreyImage film(int rig, int side, const std::vector<StandingBoard>& boards,
                   const PictureFaults& faults);
    Pose world_from_board_near(int rig) { return truth(rig).world_from_left * board_near_rig(rig); }

  private:
    bool whole_in_picture(const CameraModel& camera, const Pose& camera_from_board) const;
    Pose turned_board(double tilt_rad, const Eigen::Vector3d& middle_m);

    BoardCamera& camera(int rig, int side);

    std::vector<BoardPattern> patterns_;
    BoardPattern pattern_;  ///< the first one
    std::mt19937_64 random_;
    std::vector<StereoCalibration> truths_;
    /// Two per rig, created on first use, since computing a lens takes longer than an image.
    std::vector<std::optional<BoardCamera>> cameras_;
};

}  // namespace vantage
