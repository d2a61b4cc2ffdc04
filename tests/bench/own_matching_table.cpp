#include "tests/bench/own_matching_table.h"

#include <array>
#include <chrono>
#include <memory>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "rig_firmware/stereo/matcher.h"
#include "rig_firmware/stereo/passes/temporal_pass.h"
#include "tests/support/deviation_along_time.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds stage_time{2};
constexpr int width_px = 320, height_px = 240, disparities = 64;
constexpr double noise_sigma = 1;
/// The first of them settle what is filtered along time.
constexpr std::uint64_t instants = 26, settled_after = 18;

StereoCalibration rig_at(double azimuth_deg) {
    return ideal_virtual_rig({.azimuth_rad = azimuth_deg * std::numbers::pi / 180,
                              .width_px = width_px,
                              .height_px = height_px});
}

VirtualView camera_of(const StereoCalibration& rig) {
    return {width_px, height_px, rig.left.K(), rig.world_from_left};
}

/// A rig of the stage, with all that its daemon would do to a pair.
class MatchingRig {
  public:
    MatchingRig(const ShaderLibrary& library, double azimuth_deg, std::uint64_t seed)
        : calibration_(rig_at(azimuth_deg)),
          rig_(calibration_, {.sigma = noise_sigma, .seed = seed}),
          left_(TextureFormat::rgba8, width_px, height_px),
          right_(TextureFormat::rgba8, width_px, height_px),
          matcher_(make_matcher(default_matcher(MatchPreset::quality), library,
                                {.width_px = width_px,
                                 .height_px = height_px,
                                 .disparities = disparities,
                                 .preset = MatchPreset::quality})),
          steady_(library, width_px, height_px) {
        view_.name = fmt::format("{:g}", azimuth_deg);
        view_.K = calibration_.left.K();
        view_.world_from_camera = calibration_.world_from_left;
        view_.baseline_m = calibration_.rectified.baseline_m;
    }

    /// The same instant anew, with other noise.
    void film(VirtualStage& stage, std::uint64_t instant) {
        VirtualStereoFrame frame = rig_.render(stage, stage_time, instant);
        left_.upload(frame.left);
        right_.upload(frame.right);
        const cv::Mat found = steady_.run(matcher_->match(left_, right_), left_).download();
        view_.colour = frame.left;
        own_m_ = depth_of(found);
        exact_m_ = depth_of(frame.exact_disparity);
    }

    DepthView view(bool with_own_depth) const {
        DepthView view = view_;
        view.depth_m = with_own_depth ? own_m_ : exact_m_;
        return view;
    }

  private:
    DepthImage depth_of(const cv::Mat& disparity) const {
        DepthImage depth_m(disparity.size());
        for (int y = 0; y < depth_m.rows; ++y)
            for (int x = 0; x < depth_m.cols; ++x) {
                const auto steps = disparity.at<std::uint16_t>(y, x);
                depth_m(y, x) = steps > 0
                                    ? static_cast<float>(calibration_.rectified.depth_m(
                                          steps / static_cast<double>(disparity_steps_per_px)))
                                    : 0.0f;
            }
        return depth_m;
    }

    StereoCalibration calibration_;
    VirtualRig rig_;
    Texture left_, right_;
    std::unique_ptr<Matcher> matcher_;
    TemporalPass steady_;
    DepthView view_;
    DepthImage own_m_, exact_m_;
};

std::string row(const ShaderLibrary& library, std::uint64_t set, double apart_deg) {
    VirtualStage stage(library, set);
    std::vector<std::unique_ptr<MatchingRig>> rigs;
    for (const double place : {-1.5, -0.5, 0.5, 1.5})
        rigs.push_back(std::make_unique<MatchingRig>(library, place * apart_deg, rigs.size() + 1));
    const StereoCalibration middle = rig_at(0);
    const VirtualView target = camera_of(middle);
    const ColourImage truth =
        stage.render({width_px, height_px, target.K, target.world_from_camera}, stage_time).colour;

    const std::array synthesisers = {make_synthesiser("fused", library),
                                     make_synthesiser("fused", library)};
    std::array<ColourImage, 2> pictures;
    std::vector<ColourImage> along_time, camera;
    for (std::uint64_t instant = 0; instant < instants; ++instant) {
        for (const auto& rig : rigs) rig->film(stage, instant);
        for (const bool own : {false, true}) {
            std::vector<DepthView> views;
            for (const auto& rig : rigs) views.push_back(rig->view(own));
            synthesisers[own]->set_views(views);
            pictures[own] = synthesisers[own]->render(target).download();
        }
        if (instant < settled_after) continue;
        along_time.push_back(pictures[1]);
        camera.push_back(truth.clone());
        add_sensor_noise(camera.back(), {.sigma = noise_sigma, .seed = 99}, 0, instant);
    }
    const cv::Mat1b everywhere(height_px, width_px, uchar{255});
    const std::string name = set == 0 ? "the demo's" : fmt::format("generated {}", set);
    std::string text = fmt::format("| {} | {:g} |", name, apart_deg);
    for (const ColourImage& picture : pictures)
        text += fmt::format(" {:.2f} | {:.3f} |", psnr_db(picture, truth), ssim(picture, truth));
    return text + fmt::format(" {:.3f} | {:.2f} |\n", coverage(pictures[1]),
                              deviation_along_time(along_time, everywhere) /
                                  deviation_along_time(camera, everywhere));
}

}  // namespace

std::string own_matching_table(const ShaderLibrary& library) {
    std::string text = fmt::format(
        "\n### The virtual stage, depth by the rigs' own matching, {}x{}\n\n"
        "Four rigs, sensor noise of {:g} grey level; `fused` midway between the middle two, from "
        "exact depth and from what `quality` finds. Wavering: standard deviation along time on a "
        "still stage against that of a camera with the same noise.\n\n"
        "| set | rigs apart (degrees) | exact: PSNR dB | SSIM | own: PSNR dB | SSIM | coverage | "
        "wavering |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        width_px, height_px, noise_sigma);
    for (const std::uint64_t set : {0u, 1u, 2u, 4u, 5u, 6u})
        for (const double apart_deg : {20, 40}) text += row(library, set, apart_deg);
    return text;
}

}  // namespace vantage
