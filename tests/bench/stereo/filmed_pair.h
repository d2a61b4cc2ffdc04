#pragma once

#include <chrono>
#include <cmath>
#include <memory>

#include "common/gl/context/egl_context.h"
#include "common/gl/shader_library.h"
#include "common/image/colour_map.h"
#include "common/virtual_stage/virtual_rig.h"
#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// What an ideal rig sees of the virtual stage, with the exact disparity of the left picture in
/// fractions of a pixel.
struct FilmedPair {
    ColourImage left, right;
    cv::Mat1f disparity_px;
};

/// Films one stage from one place.
class StageFilm {
  public:
    StageFilm(VirtualStage& stage, const VirtualRigPlacement& placement)
        : stage_(stage), calibration_(ideal_virtual_rig(placement)) {}

    FilmedPair at(std::chrono::nanoseconds stage_time, const SensorNoise& noise,
                  std::uint64_t frame_index = 0) {
        const StageCamera camera{calibration_.left.width_px, calibration_.left.height_px,
                                 calibration_.left.K(), calibration_.world_from_left};
        const VirtualStereoFrame seen =
            VirtualRig(calibration_, noise, false).render(stage_, stage_time, frame_index);
        const DepthImage depth_m =
            stage_.render(camera, stage_time, {.pictures = StagePictures::depth}).depth_m;
        FilmedPair pair{seen.left, seen.right, cv::Mat1f(depth_m.size())};
        for (int y = 0; y < depth_m.rows; ++y)
            for (int x = 0; x < depth_m.cols; ++x)
                pair.disparity_px(y, x) = static_cast<float>(
                    calibration_.rectified.disparity_px(static_cast<double>(depth_m(y, x))));
        return pair;
    }

  private:
    VirtualStage& stage_;
    StereoCalibration calibration_;
};

/// A set of the virtual stage at one instant: 0 is the show, others are random sets, seen from one
/// side each, with sensor noise (8-bit grey levels).
inline FilmedPair filmed_background(const ShaderLibrary& library, std::uint64_t set, cv::Size size,
                                    double noise_sigma) {
    VirtualStage stage(library, set);
    return StageFilm(stage, {.azimuth_rad = 0.4 * static_cast<double>(set),
                             .width_px = size.width,
                             .height_px = size.height})
        .at(std::chrono::seconds(1), {.sigma = noise_sigma});
}

inline Texture uploaded(const ColourImage& picture) {
    Texture texture(TextureFormat::rgba8, picture.cols, picture.rows);
    texture.upload(picture);
    return texture;
}

/// Disparities in pixels, 0 = unknown.
inline cv::Mat1f matched(Matcher& matcher, const FilmedPair& pair) {
    const Texture left = uploaded(pair.left), right = uploaded(pair.right);
    return to_float_px(matcher.match(left, right).download());
}

}  // namespace vantage
