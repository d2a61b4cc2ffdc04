#include "calib_tools/commands/stage_pairs.h"

#include <cmath>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib_tools/report/calibration_text.h"
#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/config/calibration_file.h"
#include "common/config/intrinsics_file.h"
#include "common/config/toml_edit.h"

namespace vantage {
namespace {

constexpr int first_port = 5600;

std::string name_of(const CameraPair& pair, const std::vector<SingleCamera>& cameras) {
    constexpr std::size_t longest_name = 64;
    return (cameras[pair.left].name + "-" + cameras[pair.right].name).substr(0, longest_name);
}

/// The lines of [source] that play or open both cameras.
std::string source_lines(const SingleCamera& left, const SingleCamera& right) {
    if (left.source.empty() || right.source.empty())
        return "kind = \"files\"\n# The stage file names no source of these cameras.\n"
               "# left = \"left.mp4\"\n# right = \"right.mp4\"\n";
    if (left.source.starts_with("/dev/"))
        return fmt::format("kind = \"v4l2\"\nleft_device = {}\nright_device = {}\n",
                           toml_string(left.source), toml_string(right.source));
    const bool is_file = std::filesystem::path(left.source).has_extension();
    if (!is_file)
        return fmt::format("kind = \"libcamera\"\nleft_device = {}\nright_device = {}\n",
                           toml_string(left.source), toml_string(right.source));
    const auto absolute = [](const std::string& path) {
        return toml_string(std::filesystem::absolute(path).lexically_normal().string());
    };
    return fmt::format("kind = \"files\"\nleft = {}\nright = {}\n", absolute(left.source),
                       absolute(right.source));
}

std::string rig_text(const CameraPair& pair, const std::vector<SingleCamera>& cameras, int port) {
    const SingleCamera &left = cameras[pair.left], &right = cameras[pair.right];
    return fmt::format(
        "# A rig of the cameras {} and {}: vantage-rig run --config THIS_FILE.\n"
        "version = 1\nname = \"{}\"\ncalibration = \"{}.yaml\"\n\n"
        "[source]\n{}width_px = {}\nheight_px = {}\n\n[match]\ndisparities = {}\n\n"
        "[stream]\nbind = \"tcp://127.0.0.1:{}\"\n",
        left.name, right.name, name_of(pair, cameras), name_of(pair, cameras),
        source_lines(left, right), left.model.width_px, left.model.height_px, pair.disparities,
        port);
}

std::string pair_sentence(const CameraPair& pair, const std::vector<SingleCamera>& cameras) {
    const RectifiedStereo& r = pair.calibration.rectified;
    const double far_m = farthest_m(r);
    return fmt::format(
        "rig {}: {} left and {} right, {:.3f} m and {:.1f} degrees apart, rolled by {:.1f} "
        "degrees, {:.0f} % of their views in common at {:.2f} m; {}x{}, {} disparities reach from "
        "{:.2f} m {}",
        name_of(pair, cameras), cameras[pair.left].name, cameras[pair.right].name, pair.baseline_m,
        pair.angle_deg, pair.roll_deg, 100 * pair.overlap, pair.distance_m, r.width_px, r.height_px,
        pair.disparities, nearest_m(r, pair.disparities),
        std::isfinite(far_m) ? fmt::format("to {:.2f} m", far_m) : "on");
}

std::string limits_sentence(const PairLimits& limits) {
    return fmt::format(
        "limits of a pair: at most {} degrees between the axes and {} of roll, at least {:.0f} % "
        "of the views in common at the middle of the stage, a baseline of at least {} m and at "
        "most {:.0f} % of the distance to it",
        limits.most_angle_deg, limits.most_roll_deg, 100 * limits.least_overlap,
        limits.least_baseline_m, 100 * limits.most_baseline_share);
}

nlohmann::ordered_json to_json(const CameraPairs& formed,
                               const std::vector<SingleCamera>& cameras) {
    nlohmann::ordered_json result{{"rigs", nlohmann::ordered_json::array()},
                                  {"singles", nlohmann::ordered_json::array()}};
    for (const CameraPair& pair : formed.pairs)
        result["rigs"].push_back({{"name", name_of(pair, cameras)},
                                  {"left", cameras[pair.left].name},
                                  {"right", cameras[pair.right].name},
                                  {"baseline_m", pair.baseline_m},
                                  {"angle_deg", pair.angle_deg},
                                  {"roll_deg", pair.roll_deg},
                                  {"distance_m", pair.distance_m},
                                  {"overlap", pair.overlap},
                                  {"disparities", pair.disparities}});
    for (const CameraPairs::Single& single : formed.singles)
        result["singles"].push_back(
            {{"name", cameras[single.camera].name}, {"reason", single.reason}});
    return result;
}

}  // namespace

void form_stage_pairs(const StagePairsOptions& options) {
    const std::vector<SingleCamera> cameras = load_stage_cameras(options.stage);
    const CameraPairs formed = form_pairs(cameras, options.limits, options.alpha);
    if (formed.pairs.empty()) {
        std::string reasons;
        for (const CameraPairs::Single& single : formed.singles)
            reasons += fmt::format("; {}: {}", cameras[single.camera].name, single.reason);
        fail(
            "no two of the {} make a rig{}; {}. With outlines of the performers they can still be "
            "rendered: vantage render --views {}",
            counted(cameras.size(), "camera"), reasons, limits_sentence(options.limits),
            options.stage);
    }
    const std::filesystem::path folder = options.output;
    make_folder(folder);
    std::string stage = "# Written by vantage-calib stage --pairs auto.\nversion = 1\n";
    int port = first_port;
    for (const CameraPair& pair : formed.pairs) {
        const std::string name = name_of(pair, cameras);
        save_calibration(folder / (name + ".yaml"), pair.calibration,
                         {.date = date_now(),
                          .tool = "vantage-calib stage --pairs auto",
                          .alpha = options.alpha});
        write_text_atomically(folder / (name + ".toml"), rig_text(pair, cameras, port));
        stage += fmt::format("\n[[rigs]]\nname = \"{}\"\nendpoint = \"tcp://127.0.0.1:{}\"\n", name,
                             port++);
        log_info("{} and {}.yaml written", (folder / (name + ".toml")).string(), name);
    }
    for (const CameraPairs::Single& single : formed.singles) {
        SingleCamera camera = cameras[single.camera];
        const std::string file = camera.name + ".yaml";
        save_intrinsics(folder / file, camera.model,
                        record_of_foreign_lens(camera.model, "vantage-calib stage --pairs auto"));
        if (std::filesystem::exists(camera.source))
            camera.source = std::filesystem::absolute(camera.source).string();
        if (!camera.outline.empty()) camera.outline = std::filesystem::absolute(camera.outline);
        stage += "\n# No rig: a view of colour and outline for vantage render --views.\n" +
                 stage_camera_text(camera, file);
    }
    write_text_atomically(folder / "stage.toml", stage);
    log_info("{} written", (folder / "stage.toml").string());
    if (options.json) {
        std::cout << to_json(formed, cameras).dump(2) << '\n';
        return;
    }
    for (const CameraPair& pair : formed.pairs) std::cout << pair_sentence(pair, cameras) << '\n';
    for (const CameraPairs::Single& single : formed.singles)
        std::cout << "a view of colour and outline only: " << cameras[single.camera].name << ", "
                  << single.reason << '\n';
    std::cout << limits_sentence(options.limits) << '\n';
}

}  // namespace vantage
