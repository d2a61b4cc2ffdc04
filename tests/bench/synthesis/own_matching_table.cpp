#include "tests/bench/synthesis/own_matching_table.h"

#include <array>
#include <chrono>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "common/virtual_stage/virtual_stage.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/bench/synthesis/matching_rig.h"
#include "tests/support/deviation_along_time.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds stage_time{2};
const cv::Size size{320, 240};
constexpr double noise_sigma = 1;
/// The first of them settle what is filtered along time.
constexpr std::uint64_t instants = 26, settled_after = 18;

std::string row(const ShaderLibrary& library, std::uint64_t scene, double apart_deg) {
    VirtualStage stage(library, scene);
    std::vector<std::unique_ptr<MatchingRig>> rigs;
    for (const double place : {-1.5, -0.5, 0.5, 1.5})
        rigs.push_back(std::make_unique<MatchingRig>(library, place * apart_deg, rigs.size() + 1,
                                                     MatchingRig::Settings{}));
    const VirtualView target = camera_of(rig_at(0, size));
    const ColourImage truth =
        stage.render({size.width, size.height, target.K, target.world_from_camera}, stage_time)
            .colour;

    const std::array synthesisers = {make_synthesiser("fused", library),
                                     make_synthesiser("fused", library)};
    std::array<ColourImage, 2> pictures;
    std::vector<ColourImage> along_time, camera;
    for (std::uint64_t instant = 0; instant < instants; ++instant) {
        for (const auto& rig : rigs) rig->film(stage, stage_time, instant);
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
    const cv::Mat1b everywhere(size.height, size.width, uchar{255});
    const std::string name = scene == 0 ? "the demo's" : fmt::format("generated {}", scene);
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
        "Four rigs have a sensor noise of {:g} grey level. `fused` renders midway between the "
        "middle two, from exact depth and from the depth of `quality`. Flicker is the standard "
        "deviation over time on a still stage, relative to that of a camera with the same "
        "noise.\n\n"
        "| scene | rigs apart (degrees) | exact: PSNR dB | SSIM | own: PSNR dB | SSIM | coverage | "
        "flicker |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        size.width, size.height, noise_sigma);
    for (const std::uint64_t scene : {0u, 1u, 2u, 4u, 5u, 6u})
        for (const double apart_deg : {20, 40}) text += row(library, scene, apart_deg);
    return text;
}

}  // namespace vantage
