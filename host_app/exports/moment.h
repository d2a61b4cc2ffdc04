#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.h"
#include "common/image/image.h"
#include "common/take/format/frame_storage.h"
#include "common/take/take_reader.h"
#include "host_app/takes/take_show.h"

namespace vantage {

/// The view of one rig at a moment.
struct MomentView {
    std::string rig;
    ColourImage colour;  ///< corrected to the stage's colours
    /// The JPEG as it came, if the rig has no colour correction; otherwise empty.
    std::vector<std::byte> jpeg;
    DepthImage depth_m;  ///< with the same field of view, may be smaller; 0: unknown
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();  ///< of the colour image, px
    Pose world_from_camera = Pose::Identity();

    /// K for the size of the depth map.
    Eigen::Matrix3d depth_K() const;
    /// The depth map scaled to the size of the colour image; empty if there is none.
    DepthImage depth_of_pixels() const;
};

/// The views of all rigs at one pulse, for exports.
struct Moment {
    std::uint64_t pulse = 0;
    double pulse_rate_hz = 30;
    std::vector<MomentView> views;
    std::uint64_t damaged = 0;  ///< number of rigs whose frame is damaged
};

/// A point of a visible surface.
struct SurfacePoint {
    Eigen::Vector3f position_m;  ///< in the stage's world frame
    cv::Vec3b rgb;
};
/// The points of every `step`-th pixel in x and y with a known depth.
std::vector<SurfacePoint> surface_points(const Moment& moment, int step);
/// Triangles between neighbouring pixels of one surface, as indices of the points of step 1.
/// Counterclockwise as seen from the rig.
std::vector<std::array<std::uint32_t, 3>> surface_triangles(const Moment& moment);

/// Loads moments of a take. Not thread-safe.
class MomentReader {
  public:
    /// `take` must outlive this object. Throws Error if the take's head is damaged.
    explicit MomentReader(const TakeReader& take);

    Moment at(std::uint64_t pulse);

  private:
    const TakeReader& take_;
    TakeShow show_;
    std::deque<FrameRestorer> restorers_;
};

// Exports of one moment in the formats of other programs. Files are written atomically; a `folder`
// is created. All throw Error if a file cannot be written.

/// Coloured points in Stanford's polygon format (PLY), binary, in metres in the stage's world frame
/// (y up): points only...
void write_ply(const std::vector<SurfacePoint>& points, const std::filesystem::path& file);
/// ...and points with surfaces.
void write_ply(const Moment& moment, const std::filesystem::path& file);
/// glTF 2.0 in one file: an unlit primitive of triangles in the stage's world frame.
void write_glb(const Moment& moment, const std::filesystem::path& file);

/// For training radiance fields and Gaussian splats: images/, depth/ (16-bit PNG, millimetres,
/// 0 = unknown), transforms.json (OpenGL's axes) and sparse/0, a COLMAP model as text. In both, the
/// corner of the image is at (0, 0), half a pixel before the centre of the first pixel.
void write_training_folder(const Moment& moment, const std::filesystem::path& folder);
/// A view set for `vantage render --views`.
void write_view_set(const Moment& moment, const std::filesystem::path& folder);

/// One OpenEXR file per rig, for compositors: R, G and B as linear light
/// (Rec. 709 primaries, half floats), Z in metres along the camera's axis (floats, 0: unknown), the
/// attribute worldToCamera, and the intrinsics K in px.
void write_exr_folder(const Moment& moment, const std::filesystem::path& folder);

/// An MPEG view set of one frame for TMIV and RVS: sequence.json with the
/// cameras (OMAF's axes), and per rig NAME_texture_WxH_yuv420p10le.yuv and
/// NAME_depth_WxH_yuv420p16le.yuv. Depth is inverse, 1 (farthest) to 65535 (nearest) over the range
/// in sequence.json, 0 if unknown. An odd last row or column is cut off. Throws Error if no rig has
/// depth.
void write_mpeg_views(const Moment& moment, const std::filesystem::path& folder);

}  // namespace vantage
