#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/views/depth_view.h"
#include "rig_firmware/stereo/disparity/temporal_pass.h"
#include "rig_firmware/stereo/matcher.h"
#include "tests/bench/synthesis/matching_rig.h"

namespace vantage {

/// A flat card that stands on the virtual stage; `colour` of a place on it, in its half widths.
struct Card {
    Eigen::Vector3d middle_m;
    double half_width_m, half_height_m;
    std::function<cv::Vec3b(double across, double up)> colour;
    Eigen::Vector3d across = Eigen::Vector3d::UnitX(), up = Eigen::Vector3d::UnitY();
};

/// Draws a card into a rendering, with occlusion.
inline void paint(StageRendering& seen, const StageCamera& camera, const Card& card) {
    const Eigen::Vector3d eye = camera.world_from_camera.translation();
    const Eigen::Vector3d normal = card.across.cross(card.up);
    const Eigen::Matrix3d ray_of = camera.world_from_camera.linear() * camera.K.inverse();
    for (int y = 0; y < seen.depth_m.rows; ++y)
        for (int x = 0; x < seen.depth_m.cols; ++x) {
            const Eigen::Vector3d ray = ray_of * Eigen::Vector3d(x, y, 1);
            const double z = normal.dot(card.middle_m - eye) / normal.dot(ray);
            if (!(z > 0 && z < seen.depth_m(y, x))) continue;
            const Eigen::Vector3d from_middle = eye + z * ray - card.middle_m;
            const double across = card.across.dot(from_middle) / card.half_width_m;
            const double up = card.up.dot(from_middle) / card.half_height_m;
            if (std::abs(across) > 1 || std::abs(up) > 1) continue;
            const cv::Vec3b colour = card.colour(across, up);
            seen.colour(y, x) = {colour[0], colour[1], colour[2], 255};
            seen.depth_m(y, x) = static_cast<float>(z);
        }
}

/// A pseudo-random colour for each cell of a grid.
inline cv::Vec3b cell_colour(int column, int row, std::uint64_t seed) {
    std::uint64_t h = seed * 0x9e3779b97f4a7c15ull +
                      static_cast<std::uint64_t>(column + 1000) * 73856093u +
                      static_cast<std::uint64_t>(row + 1000) * 19349663u;
    h ^= h >> 31;
    h *= 0xbf58476d1ce4e5b9ull;
    h ^= h >> 29;
    return {static_cast<uchar>(40 + h % 180), static_cast<uchar>(40 + (h >> 16) % 180),
            static_cast<uchar>(40 + (h >> 32) % 180)};
}

/// A small rig of the virtual stage with real stereo matching, and with cards and light of the
/// test.
class PaintedRig {
  public:
    explicit PaintedRig(const ShaderLibrary& library)
        : calibration_(rig_at(0, size)),
          left_(TextureFormat::rgba8, size.width, size.height),
          right_(TextureFormat::rgba8, size.width, size.height),
          matcher_(make_matcher(default_matcher(MatchPreset::fast), library,
                                {.width_px = size.width,
                                 .height_px = size.height,
                                 .disparities = 16,
                                 .preset = MatchPreset::fast,
                                 .of_stream = true})),
          steady_(library, size.width, size.height) {}

    inline static const cv::Size size{160, 120};

    StageCamera camera() const {
        return {size.width, size.height, calibration_.left.K(), calibration_.world_from_left};
    }

    /// Renders the stage at a time, without noise; film() uses it until the next call.
    void look(VirtualStage& stage, std::chrono::nanoseconds stage_time,
              const std::vector<Card>& cards = {}) {
        StageCamera right = camera();
        right.world_from_camera.translation() +=
            calibration_.rectified.baseline_m * right.world_from_camera.linear().col(0);
        seen_left_ = stage.render(camera(), stage_time, {.stands_still = true});
        seen_right_ = stage.render(right, stage_time, {.stands_still = true});
        for (const Card& card : cards) {
            paint(seen_left_, camera(), card);
            paint(seen_right_, right, card);
        }
    }
    const StageRendering& seen() const { return seen_left_; }

    /// Adds sensor noise and matches; `light` scales the light.
    DepthView film(double light = 1) {
        ColourImage left = lit(seen_left_.colour, light), right = lit(seen_right_.colour, light);
        add_sensor_noise(left, {.sigma = 1, .seed = 1}, 0, instant_);
        add_sensor_noise(right, {.sigma = 1, .seed = 1}, 1, instant_++);
        left_.upload(left);
        right_.upload(right);
        DepthView view;
        view.name = "rig";
        view.colour = left;
        view.K = calibration_.left.K();
        view.world_from_camera = calibration_.world_from_left;
        view.baseline_m = calibration_.rectified.baseline_m;
        view.disparity =
            DisparityImage(steady_.run(matcher_->match(left_, right_), left_).download().clone());
        view.disparity_scale = DisparityScale(calibration_.rectified, size.width);
        return view;
    }

  private:
    /// Light is linear, pictures are sRGB-coded.
    static ColourImage lit(const ColourImage& picture, double light) {
        cv::Mat1b table(1, 256);
        for (int i = 0; i < 256; ++i) {
            const double code = i / 255.0;
            const double linear =
                code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
            const double less = light * linear;
            const double now =
                less <= 0.0031308 ? 12.92 * less : 1.055 * std::pow(less, 1 / 2.4) - 0.055;
            table(0, i) = cv::saturate_cast<uchar>(255 * now);
        }
        ColourImage darker;
        cv::LUT(picture, table, darker);
        for (cv::Vec4b& pixel : darker) pixel[3] = 255;
        return darker;
    }

    StereoCalibration calibration_;
    Texture left_, right_;
    std::unique_ptr<Matcher> matcher_;
    TemporalPass steady_;
    StageRendering seen_left_, seen_right_;
    std::uint64_t instant_ = 0;
};

}  // namespace vantage
