#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "common/geometry/pose.h"
#include "common/gl/shader_library.h"
#include "common/image/image.h"

namespace vantage {

/// A pinhole camera on the virtual stage. Any K (skew too) with positive focal lengths.
struct StageCamera {
    int width_px = 0, height_px = 0;
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    Pose world_from_camera = Pose::Identity();
};

/// How far lens and sensor of the stage's cameras spread a point: the standard deviation of their
/// Gaussian point spread. It leaves 12 % of the contrast at the finest pattern a sensor can hold,
/// like a colour sensor behind a good small lens; sharper pictures would be aliased as no camera's
/// are.
inline constexpr double point_spread_px = 0.65;

struct StageRendering {
    ColourImage colour;  ///< anti-aliased, sRGB-coded
    DepthImage depth_m;  ///< exact z at every pixel's centre; never 0: the set surrounds the stage
};

/// What render() draws; a picture not asked for stays empty.
enum class StagePictures { colour, depth, both };

struct StageOptions {
    StagePictures pictures = StagePictures::both;
    /// Colour as lens and sensor see it, from four samples a pixel; up to 2048 pixels a side.
    /// Otherwise a point sample at every pixel's centre.
    bool anti_aliased = true;
    /// The camera will film again from the same place: its picture of the set, which stands still,
    /// is kept, for the last four such cameras, and only what moves is drawn. The picture is the
    /// same.
    bool stands_still = false;
};

/// A television set with performers, rendered on the GPU: textured, lit, with thin structures,
/// glossy and untextured parts. World: right-handed, metres, y up, floor at y = 0; the performers
/// walk round the origin, 1 to 1.3 m from it, and are back where they were after 24 s (stage_loop).
/// The same time always gives the same picture, in every process and at any date.
class VirtualStage {
  public:
    /// Set 0 is the show that the demo films. Every other number is a set generated from it: other
    /// shapes, textures, lights, depths and performers; nothing stands right before cameras within
    /// 60 degrees of +z.
    explicit VirtualStage(const ShaderLibrary& library, std::uint64_t set = 0);
    ~VirtualStage();
    VirtualStage(VirtualStage&&) noexcept;
    VirtualStage& operator=(VirtualStage&&) noexcept;

    /// Throws Error for a size the GPU cannot draw, or for a K or pose that cannot be. Waits for
    /// the GPU. The context that made the stage must be current.
    StageRendering render(const StageCamera& camera, std::chrono::nanoseconds stage_time,
                          const StageOptions& options = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
