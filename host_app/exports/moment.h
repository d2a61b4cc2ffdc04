#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.h"
#include "common/image/image.h"
#include "common/take/format/frame_storage.h"
#include "common/take/take_reader.h"
#include "host_app/takes/take_show.h"

namespace vantage {

/// What one rig saw.
struct MomentView {
    std::string rig;
    ColourImage colour;  ///< in the stage's colours
    /// As it came, where the rig's colours are the stage's; else empty.
    std::vector<std::byte> jpeg;
    DepthImage depth_m;  ///< of the same field of view, may be smaller; 0: unknown
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();  ///< of the colour picture, px
    Pose world_from_camera = Pose::Identity();

    /// K of the depth map.
    Eigen::Matrix3d depth_K() const;
    /// The depth map in as many pixels as the colour picture has; empty as it is.
    DepthImage depth_of_pixels() const;
};

/// What all rigs saw at one pulse, for other programs.
struct Moment {
    std::uint64_t pulse = 0;
    double pulse_rate_hz = 30;
    std::vector<MomentView> views;
    std::uint64_t damaged = 0;  ///< rigs whose frame is not what was written
};

/// A point of a surface that a rig saw.
struct SurfacePoint {
    Eigen::Vector3f position_m;  ///< in the stage
    cv::Vec3b rgb;
};
/// Of every `step`th pixel either way that has a depth.
std::vector<SurfacePoint> surface_points(const Moment& moment, int step);
/// Triangles between them, step 1, by their numbers: of neighbours in a rig's picture that are on
/// one surface. Counterclockwise as the rig sees them.
std::vector<std::array<std::uint32_t, 3>> surface_triangles(const Moment& moment);

/// Gives moments of a take. Not thread-safe.
class MomentReader {
  public:
    /// `take` must outlive this. Throws Error if the take's head is damaged.
    explicit MomentReader(const TakeReader& take);

    Moment at(std::uint64_t pulse);

  private:
    const TakeReader& take_;
    TakeShow show_;
    std::deque<FrameRestorer> restorers_;
};

}  // namespace vantage
