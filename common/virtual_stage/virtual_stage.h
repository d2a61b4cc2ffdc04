#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "common/geometry/pose.h"
#include "common/gl/shader_library.h"
#include "common/image/image.h"

namespace vantage {

/// A pinhole camera on the virtual stage. Any K (also with skew) with positive focal lengths.
struct StageCamera {
    int width_px = 0, height_px = 0;
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    Pose world_from_camera = Pose::Identity();
};

/// The point spread of lens and sensor of the stage's cameras: the standard deviation of a
/// Gaussian. It leaves 12 % of the contrast at the sensor's Nyquist frequency, like a colour sensor
/// behind a good small lens; sharper images would be aliased more than a real camera's.
inline constexpr double point_spread_px = 0.65;

struct StageRendering {
    ColourImage colour;  ///< antialiased, sRGB-coded
    DepthImage depth_m;  ///< true z at every pixel's centre; never 0: the scene surrounds the stage
};

/// The images that render() draws; the others stay empty.
enum class StagePictures { colour, depth, both };

struct StageOptions {
    StagePictures pictures = StagePictures::both;
    /// Colour as lens and sensor see it, from four samples per pixel, for sides of up to 2048 px.
    /// Otherwise one sample at every pixel's centre.
    bool anti_aliased = true;
    /// The camera will film again from the same place. Its image without performers is cached, for
    /// the last four such cameras, and only moving parts are drawn. The result is the same.
    bool stands_still = false;
};

/// A studio with performers, rendered on the GPU: textured and lit, with thin structures and glossy
/// and untextured surfaces. World: right-handed, metres, y up, floor at y = 0. The performers walk
/// around the origin at 1 to 1.3 m, and repeat their motion after 24 s (stage_loop). The same time
/// always gives the same image, in every process and at any date.
class VirtualStage {
  public:
    /// Scene 0 is the demo's studio. Every other number is the seed of a random scene with other
    /// shapes, textures, lights, depths and performers; nothing stands right in front of cameras
    /// within 60 degrees of +z. With a million added, performers wear plain colours.
    explicit VirtualStage(const ShaderLibrary& library, std::uint64_t scene = 0);
    ~VirtualStage();
    VirtualStage(VirtualStage&&) noexcept;
    VirtualStage& operator=(VirtualStage&&) noexcept;

    /// Throws Error for a size that the GPU cannot draw, or an invalid K or pose. Waits for the
    /// GPU. The context that was current at construction must be current.
    StageRendering render(const StageCamera& camera, std::chrono::nanoseconds stage_time,
                          const StageOptions& options = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
