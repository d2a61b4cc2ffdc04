#include "tests/support/boards/rendered_stage.h"

#include <cmath>
#include <numbers>

#include "calib_tools/board/board_drawing.h"

namespace vantage {
namespace {

constexpr double arc_rad = 120 * std::numbers::pi / 180, distance_m = 4, height_m = 2.2;
// The board on the floor, the origin of the world, lies in front of the middle of the stage, where
// rigs see it at a steeper angle.
const Eigen::Vector3d middle_m(0, 0, -1.2), target_m(0, 0.5, -1.2);

CameraModel lens(int width_px, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    CameraModel camera;
    camera.width_px = width_px;
    camera.height_px = 3 * width_px / 4;
    camera.fx_px = (0.95 + 0.02 * unit(random)) * width_px;
    camera.fy_px = camera.fx_px * (1 + 0.002 * unit(random));
    camera.cx_px = 0.5 * (width_px - 1) + 0.015 * width_px * unit(random);
    camera.cy_px = 0.5 * (camera.height_px - 1) + 0.015 * width_px * unit(random);
    camera.distortion = {-0.2 + 0.03 * unit(random), 0.08 + 0.02 * unit(random),
                         5e-4 * unit(random), 5e-4 * unit(random), 0};
    return camera;
}

Eigen::Matrix3d turn(double about_x, double about_y, double about_z) {
    return (Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(about_z, Eigen::Vector3d::UnitZ()))
        .toRotationMatrix();
}

Eigen::Vector3d on_arc(double place, double radius_m) {
    const double azimuth = (place / (RenderedStage::rig_count - 1) - 0.5) * arc_rad;
    return middle_m +
           Eigen::Vector3d(radius_m * std::sin(azimuth), height_m, radius_m * std::cos(azimuth));
}

}  // namespace

std::vector<Pose> cube_faces(const BoardPattern& face) {
    const double half_m = 0.5 * (face.columns + 1) * face.square_m + board_margin_m(face);
    const Eigen::Vector3d middle = 0.5 * face.corner_m(face.corner_count() - 1);
    std::vector<Pose> faces;
    const auto add = [&](const Eigen::Matrix3d& body_from_face) {
        Pose pose = Pose::Identity();
        pose.linear() = body_from_face;
        pose.translation() = -half_m * body_from_face.col(2) - body_from_face * middle;
        faces.push_back(pose);
    };
    // A board's y points down its front and its z into it.
    Eigen::Matrix3d front;
    front << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    for (int i = 0; i < 4; ++i) add(turn(0, 0.5 * std::numbers::pi * i, 0) * front);
    add(turn(-0.5 * std::numbers::pi, 0, 0) * front);
    return faces;
}

std::vector<BoardPattern> floor_and_hand_board() {
    std::vector<BoardPattern> patterns(2, chessboard_pattern("5x4", 0.15));
    for (BoardPattern& pattern : patterns) {
        pattern.kind = BoardKind::charuco;
        pattern.marker_m = 0.105;
        pattern.dictionary = "4X4_50";
    }
    patterns[1].first_marker = 20;
    return patterns;
}

RenderedStage::RenderedStage(const std::vector<BoardPattern>& patterns, int width_px,
                             std::uint64_t seed)
    : patterns_(patterns), pattern_(patterns.front()), random_(seed), cameras_(2 * rig_count) {
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < rig_count; ++i) {
        StereoCalibration rig;
        rig.left = lens(width_px, random_);
        rig.right = lens(width_px, random_);
        rig.right_from_left.linear() =
            turn(0.01 * unit(random_), 0.03 * unit(random_), 0.01 * unit(random_));
        rig.right_from_left.translation() =
            Eigen::Vector3d(-0.12, 0.002 * unit(random_), 0.003 * unit(random_));
        rig.world_from_left = look_at(on_arc(i, distance_m), target_m);
        truths_.push_back(rig);
    }
}

BoardCamera& RenderedStage::camera(int rig, int side) {
    std::optional<BoardCamera>& camera = cameras_[static_cast<std::size_t>(2 * rig + side)];
    if (!camera) camera.emplace(patterns_, side == 0 ? truth(rig).left : truth(rig).right);
    return *camera;
}

bool RenderedStage::whole_in_picture(const CameraModel& camera,
                                     const Pose& camera_from_board) const {
    for (const int id : {0, pattern_.columns - 1, pattern_.corner_count() - pattern_.columns,
                         pattern_.corner_count() - 1}) {
        // A detector needs the outer squares and some white around them.
        const Eigen::Vector3d corner = pattern_.corner_m(id);
        const Eigen::Vector3d middle = 0.5 * pattern_.corner_m(pattern_.corner_count() - 1);
        const Eigen::Vector3d outer =
            corner + 1.3 * pattern_.square_m * (corner - middle).cwiseSign();
        const auto pixel = camera.project(camera_from_board * outer);
        if (!pixel || pixel->x() < 0 || pixel->y() < 0 || pixel->x() > camera.width_px - 1 ||
            pixel->y() > camera.height_px - 1)
            return false;
    }
    return true;
}

Pose RenderedStage::turned_board(double tilt_rad, const Eigen::Vector3d& middle_m) {
    std::uniform_real_distribution<double> tilt(-tilt_rad, tilt_rad);
    Pose pose = Pose::Identity();
    pose.linear() = turn(tilt(random_), tilt(random_), 0.5 * tilt(random_));
    pose.translation() =
        middle_m - pose.linear() * (0.5 * pattern_.corner_m(pattern_.corner_count() - 1));
    return pose;
}

Pose RenderedStage::board_near_rig(int rig) {
    std::uniform_real_distribution<double> place(-0.4, 0.4), depth(1.3, 3.2);
    const double board_m = pattern_.columns * pattern_.square_m;
    for (;;) {
        const double z = depth(random_) * board_m;
        const Pose pose = turned_board(0.65, {place(random_) * z, 0.75 * place(random_) * z, z});
        if (whole_in_picture(truth(rig).left, pose) &&
            whole_in_picture(truth(rig).right, truth(rig).right_from_left * pose))
            return pose;
    }
}

Pose RenderedStage::board_before_pair(int pair) {
    std::uniform_real_distribution<double> place(-0.25, 0.25), depth(1.8, 4.2);
    // A person between the two rigs holds the board in front of them.
    const Pose between = look_at(on_arc(pair + 0.5, distance_m), target_m);
    for (;;) {
        const double z = depth(random_);
        const Pose world_from_board =
            between * turned_board(0.45, {place(random_) * z, 0.75 * place(random_) * z, z});
        bool seen = true;
        for (const int rig : {pair, pair + 1})
            seen = seen && whole_in_picture(truth(rig).left, truth(rig).world_from_left.inverse() *
                                                                 world_from_board);
        if (seen) return world_from_board;
    }
}

Pose RenderedStage::board_on_floor() const {
    Pose pose = Pose::Identity();
    pose.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    pose.translation() = -(pose.linear() * (0.5 * pattern_.corner_m(pattern_.corner_count() - 1)));
    return pose;
}

Pose RenderedStage::wand_in_the_middle() {
    std::uniform_real_distribution<double> unit(-1, 1);
    Pose pose = Pose::Identity();
    pose.linear() = turn(0.35 * unit(random_), std::numbers::pi * unit(random_), 0) *
                    turn(0, 0, 0.35 * unit(random_));
    pose.translation() = middle_m + Eigen::Vector3d(0.7 * unit(random_), 1.1 + 0.4 * unit(random_),
                                                    0.7 * unit(random_));
    return pose;
}

GreyImage RenderedStage::film(int rig, int side, const Pose& world_from_board,
                              const PictureFaults& faults) {
    return film(rig, side, {StandingBoard{0, world_from_board}}, faults);
}

GreyImage RenderedStage::film(int rig, int side, const std::vector<StandingBoard>& boards,
                              const PictureFaults& faults) {
    Pose camera_from_world = truth(rig).world_from_left.inverse();
    if (side == 1) camera_from_world = truth(rig).right_from_left * camera_from_world;
    std::vector<BoardCamera::PlacedBoard> placed;
    for (const StandingBoard& board : boards)
        placed.push_back({board.board, camera_from_world * board.world_from_board});
    return camera(rig, side).film(placed, faults, random_());
}

}  // namespace vantage
