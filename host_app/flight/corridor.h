#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_app/flight/camera_state.h"

namespace vantage {

/// Pose and angle of view of one rig's camera.
struct CorridorRig {
    Pose world_from_camera = Pose::Identity();
    double half_width = 0.46, half_height = 0.35;  ///< of the image, at a depth of 1
};

/// The stage as a ball, the simplest model of its extent.
struct StageExtent {
    Eigen::Vector3d centre_m{0, 1, 0};
    double radius_m = 2;      ///< of the volume that performers use
    double background_m = 4;  ///< distance from the centre to the background
};

/// Reason for which most of the uncovered part of a picture is lost.
enum class CoverageLoss {
    aside,     ///< the rigs see those surfaces at a grazing angle or not at all
    too_near,  ///< the camera is so near that the rigs' depth is too coarse
    outside,   ///< outside the images of all rigs
    behind,    ///< seen from the far side, or behind the rigs
};
/// Text for operators, to follow "most of it": "is turned away from the rigs".
const char* words_of(CoverageLoss loss);
/// JSON value: "aside", "too_near", "outside", "behind".
const char* key_of(CoverageLoss loss);

/// Part of a virtual camera's picture that the rigs can show.
struct Coverage {
    double share = 1;  ///< 0..1; the middle of the picture has the largest weight
    CoverageLoss loss = CoverageLoss::aside;
};

enum class CorridorPlace { inside, edge, beyond };
/// JSON value: "inside", "edge", "beyond".
const char* key_of(CorridorPlace place);

/// Coverage of a session's camera, now and summed up.
struct CorridorStats {
    std::optional<Coverage> now;      ///< empty: not known yet
    double edge_s = 0, beyond_s = 0;  ///< time at the edge and beyond the end of the corridor
    double least_share = 1;
};

/// Predicts for which virtual cameras the rigs can show the picture, from the poses and angles of
/// view of the rigs alone, on a grid of rays.
///
/// A ray through the performers' volume shows half performers and half background. Performers count
/// as small balls, of which a rig sees the half that faces it. A part of a ball is covered where a
/// rig sees it at no less than half of the virtual camera's pixel density. The background is a
/// shell around the stage, covered where a rig's image contains the point. Occlusion between
/// performers is not predicted.
class Corridor {
  public:
    /// Below a share of `edge` a camera slows down on its way out; at `end` it stops. Both were
    /// chosen on the demo stage: 30 degrees beside the last rig half of the background behind the
    /// performers begins to be missing, and 50 degrees beside it their outlines fray.
    static constexpr double edge = 0.85, end = 0.65;

    /// `aspect` is the height of the virtual camera's picture divided by its width.
    Corridor(std::vector<CorridorRig> rigs, const StageExtent& extent, double aspect);

    /// Without rigs nothing is covered.
    Coverage of(const CameraState& camera) const;

    static CorridorPlace place_of(double share);
    /// Factor 0..1 on the speed of a camera that loses coverage: 1 above `edge`, 0 below `end`,
    /// smooth between them.
    static double outward_speed(double share);

  private:
    /// Coverage of one ray, and the share that each kind of loss takes.
    struct RayCoverage {
        double share = 0;
        std::array<double, 4> losses{};
    };
    struct BodyCoverage : RayCoverage {
        double sharp = 1;  ///< 0..1, less where the camera is much nearer than the rigs
    };
    /// Angle at the centre of the stage between the eye and the nearest rig.
    double off_the_rigs_rad(const Eigen::Vector3d& eye_m) const;
    RayCoverage of_ray(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& direction) const;
    BodyCoverage of_body(const Eigen::Vector3d& point_m, const Eigen::Vector3d& to_eye,
                         double distance_m) const;
    RayCoverage of_background(const Eigen::Vector3d& point_m) const;
    /// 1 inside the rig's image, 0 outside, smooth at the border.
    static double in_picture(const CorridorRig& rig, const Eigen::Vector3d& in_rig);

    std::vector<CorridorRig> rigs_;
    std::vector<Pose> rigs_from_world_;
    StageExtent extent_;
    double aspect_;
};

}  // namespace vantage
