#pragma once

#include <array>
#include <vector>

#include "host_app/flight/camera_state.h"

namespace vantage {

/// Where a rig's camera stands and what its lens takes in.
struct CorridorRig {
    Pose world_from_camera = Pose::Identity();
    double half_width = 0.46, half_height = 0.35;  ///< of the picture, at a depth of 1
};

/// The stage as a ball, for want of anything better known of it.
struct StageExtent {
    Eigen::Vector3d centre_m{0, 1, 0};
    double radius_m = 2;      ///< of where performers are
    double background_m = 4;  ///< from the centre to what is behind them
};

/// What most of the picture that no rig covers is lost to.
enum class CoverageLoss {
    aside,     ///< rigs see those surfaces grazingly or not at all
    too_near,  ///< so near that rigs' depth is too coarse
    outside,   ///< outside all rigs' pictures
    behind,    ///< seen from the far side, or behind the rigs
};
/// For people, after "most of it": "is turned away from the rigs".
const char* words_of(CoverageLoss loss);
/// For machines: "aside", "too_near", "outside", "behind".
const char* key_of(CoverageLoss loss);

/// How much of a virtual camera's picture rigs can show.
struct Coverage {
    double share = 1;  ///< 0..1, the picture's middle counting most
    CoverageLoss loss = CoverageLoss::aside;
};

enum class CorridorPlace { inside, edge, beyond };
/// For machines: "inside", "edge", "beyond".
const char* key_of(CorridorPlace place);

/// Where a virtual camera's picture can be made of what the rigs see, predicted from their places
/// and lenses alone. A grid of the virtual camera's rays is followed to the stage. Where a ray
/// passes the performers, half of what it shows is taken for small balls, of which a rig sees the
/// half that faces it: covered is what some rig sees at no less than half of the density at which
/// the virtual camera does. The rest, and rays that miss the performers, show a shell around the
/// stage, covered where a rig's picture holds the point. What performers hide of one another is not
/// predicted.
class Corridor {
  public:
    /// Below `edge` a camera is slowed on its way out, at `end` it stands. Chosen by looking at the
    /// demo's stage: 30 degrees aside of its last rig half of the set behind the performers begins
    /// to be missing, 50 degrees aside they themselves fray.
    static constexpr double edge = 0.85, end = 0.65;

    /// `aspect`: height by width of the virtual camera's picture.
    Corridor(std::vector<CorridorRig> rigs, const StageExtent& extent, double aspect);

    /// Without rigs nothing is covered.
    Coverage of(const CameraState& camera) const;

    static CorridorPlace place_of(double share);
    /// 0..1 of its speed that a camera keeps which loses coverage: 1 from `edge` on, 0 from `end`
    /// down, smoothly between.
    static double outward_speed(double share);

  private:
    /// Of one ray: what is covered, and what each kind of loss takes.
    struct RayCoverage {
        double share = 0;
        std::array<double, 4> losses{};
    };
    struct BodyCoverage : RayCoverage {
        double sharp = 1;  ///< 0..1, less where the camera is much nearer than the rigs
    };
    /// Between the eye and the rig nearest to it in angle, as seen from the stage's centre.
    double off_the_rigs_rad(const Eigen::Vector3d& eye_m) const;
    RayCoverage of_ray(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& direction) const;
    BodyCoverage of_body(const Eigen::Vector3d& point_m, const Eigen::Vector3d& to_eye,
                         double distance_m) const;
    RayCoverage of_background(const Eigen::Vector3d& point_m) const;
    /// 0..1, softly at the border.
    static double in_picture(const CorridorRig& rig, const Eigen::Vector3d& in_rig);

    std::vector<CorridorRig> rigs_;
    std::vector<Pose> rigs_from_world_;
    StageExtent extent_;
    double aspect_;
};

}  // namespace vantage
