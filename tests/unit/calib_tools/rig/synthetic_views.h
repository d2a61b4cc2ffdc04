#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "calib_tools/pictures/seen_picture.h"
#include "common/geometry/camera_model.h"
#include "common/geometry/pose.h"

namespace vantage {

/// Boards held before cameras whose truth is known: corners are projected and err by Gaussian noise
/// as a good corner fit does.
class SyntheticViews {
  public:
    explicit SyntheticViews(const BoardPattern& pattern, double noise_px = 0.05,
                            std::uint64_t seed = 1)
        : pattern_(pattern), random_(seed), noise_(0, noise_px) {}

    /// What the camera sees of the board; no corners if one falls outside the picture.
    SeenPicture see(const CameraModel& camera, const Pose& camera_from_board,
                    const std::string& name) {
        SeenPicture picture;
        picture.path = name;
        picture.width_px = camera.width_px;
        picture.height_px = camera.height_px;
        for (int id = 0; id < pattern_.corner_count(); ++id) {
            const auto pixel = camera.project(camera_from_board * pattern_.corner_m(id));
            if (!pixel || pixel->x() < 0 || pixel->y() < 0 || pixel->x() > camera.width_px - 1 ||
                pixel->y() > camera.height_px - 1) {
                picture.sighting.corners.clear();
                picture.sighting.reason = "shows no whole board";
                return picture;
            }
            picture.sighting.corners.push_back(
                {id, pattern_.corner_m(id),
                 *pixel + Eigen::Vector2d(noise_(random_), noise_(random_))});
        }
        return picture;
    }

    /// A board before the camera: tilted up to 35 degrees, its middle somewhere in a cone.
    Pose hold_board(double distance_m, double spread) {
        std::uniform_real_distribution<double> tilt(-0.6, 0.6), place(-spread, spread),
            depth(0.8, 1.5);
        Pose pose = Pose::Identity();
        pose.linear() = (Eigen::AngleAxisd(tilt(random_), Eigen::Vector3d::UnitX()) *
                         Eigen::AngleAxisd(tilt(random_), Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(0.4 * tilt(random_), Eigen::Vector3d::UnitZ()))
                            .toRotationMatrix();
        const double z = distance_m * depth(random_);
        const Eigen::Vector3d middle = 0.5 * pattern_.corner_m(pattern_.corner_count() - 1);
        pose.translation() = Eigen::Vector3d(place(random_) * z, 0.75 * place(random_) * z, z) -
                             pose.linear() * middle;
        return pose;
    }

    const BoardPattern& pattern() const { return pattern_; }

  private:
    BoardPattern pattern_;
    std::mt19937_64 random_;
    std::normal_distribution<double> noise_;
};

inline CameraModel synthetic_camera(double fx_px, double fy_px, double k1) {
    CameraModel camera;
    camera.width_px = 640;
    camera.height_px = 480;
    camera.fx_px = fx_px;
    camera.fy_px = fy_px;
    camera.cx_px = 325;
    camera.cy_px = 236;
    camera.distortion = {k1, 0.05, 0.0005, -0.0003, 0};
    return camera;
}

struct SyntheticRig {
    CameraModel left = synthetic_camera(540, 540, -0.25), right = synthetic_camera(545, 544, -0.24);
    Pose right_from_left = [] {
        Pose pose = Pose::Identity();
        pose.linear() =
            Eigen::AngleAxisd(0.02, Eigen::Vector3d(0.2, 1, 0.1).normalized()).toRotationMatrix();
        pose.translation() = Eigen::Vector3d(-0.12, 0.001, 0.003);
        return pose;
    }();

    struct Series {
        std::vector<SeenPicture> left, right;
    };
    Series film(SyntheticViews& views, int count) const {
        Series series;
        for (int i = 0; static_cast<int>(series.left.size()) < count && i < 100 * count; ++i) {
            const Pose pose = views.hold_board(0.8, 0.35);
            const std::string number = std::to_string(series.left.size());
            SeenPicture l = views.see(left, pose, "left" + number + ".png");
            SeenPicture r = views.see(right, right_from_left * pose, "right" + number + ".png");
            if (!l.sighting.found() || !r.sighting.found()) continue;
            series.left.push_back(l);
            series.right.push_back(r);
        }
        return series;
    }
};

}  // namespace vantage
