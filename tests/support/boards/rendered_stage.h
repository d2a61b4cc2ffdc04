#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/geometry/stereo_calibration.h"
#include "tests/support/boards/rendered_board.h"

namespace vantage {

/// Where each of the boards is on a cube, whose frame is at its middle with y up: body_from_board.
/// The first four go round it, the fifth is on top; each board fills its face with its margin.
std::vector<Pose> cube_faces(const BoardPattern& face);

/// Two ChArUco boards of 5x4 corners that share no marker: one to lie on the floor, one to carry.
std::vector<BoardPattern> floor_and_hand_board();

/// Four rigs on an arc of 120 degrees, 4 m from the middle of a stage, each with two lenses of its
/// own, and where an assistant holds boards before them.
class RenderedStage {
  public:
    static constexpr int rig_count = 4;

    RenderedStage(const BoardPattern& pattern, int width_px, std::uint64_t seed)
        : RenderedStage(std::vector{pattern}, width_px, seed) {}
    /// Of several boards, which are of one size.
    RenderedStage(const std::vector<BoardPattern>& patterns, int width_px, std::uint64_t seed);

    /// Lenses, relative pose and world_from_left as they are.
    const StereoCalibration& truth(int rig) const { return truths_[static_cast<std::size_t>(rig)]; }
    static std::string name(int rig) { return std::string(1, static_cast<char>('A' + rig)); }

    /// A board near a rig, in every part of its picture and tilted: left_from_board.
    Pose board_near_rig(int rig);
    /// A board before the gap between rig `pair` and the next one, 1.5 to 4 m away from both:
    /// world_from_board.
    Pose board_before_pair(int pair);
    /// Before the middle of the stage, face up: world_from_board. It is what the world is named by.
    Pose board_on_floor() const;
    /// A wand that is carried about the middle of the stage, turned and tilted at random:
    /// world_from_body.
    Pose wand_in_the_middle();

    /// What a rig's left (0) or right (1) camera sees of a board that stands in the world.
    GreyImage film(int rig, int side, const Pose& world_from_board, const PictureFaults& faults);
    /// A board that stands in the world: which one, and world_from_board.
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
    BoardPattern pattern_;  ///< the first
    std::mt19937_64 random_;
    std::vector<StereoCalibration> truths_;
    /// Two of each rig, made when they film first: working out a lens takes longer than a picture.
    std::vector<std::optional<BoardCamera>> cameras_;
};

}  // namespace vantage
