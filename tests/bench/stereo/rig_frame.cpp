// Runs the whole GPU work of a rig's frame (camera conversion, rectification, matching of a stream,
// temporal filter, read-back) on black pictures and prints its passes as JSON. tools/v3d.sh runs it
// on a pretended Raspberry Pi, where programs are compiled and nothing executes; on a real GPU the
// times are the pass profiler's.
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/geometry/stereo_calibration.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/readback.h"
#include "common/rectification/rectify_pass.h"
#include "rig_firmware/capture/camera_intake.h"
#include "rig_firmware/stereo/disparity/temporal_pass.h"
#include "rig_firmware/stereo/features/feature_pass.h"
#include "rig_firmware/stereo/features/reduce_pass.h"
#include "rig_firmware/stereo/matcher.h"
#include "tests/bench/support/run_bench.h"

namespace vantage {
namespace {

struct Options {
    int width_px = 640, height_px = 400, disparities = 64;
    int match_width_px = 0;  ///< 0: the pictures are matched as they are
    // The last one is no frame in which rows are compared (FeaturePass).
    int frames = FeaturePass::row_shift_period_frames + 2;
    std::string preset = "balanced", matcher;
    PixelFormat format = PixelFormat::nv12;
};

/// A toed-in pair, whose pictures have to be resampled.
StereoCalibration toed_in_pair(const Options& options) {
    StereoCalibration calibration;
    calibration.id = "bench";
    CameraModel camera;
    camera.width_px = options.width_px;
    camera.height_px = options.height_px;
    camera.fx_px = camera.fy_px = 0.9 * options.width_px;
    camera.cx_px = 0.48 * options.width_px;
    camera.cy_px = 0.53 * options.height_px;
    calibration.left = calibration.right = camera;
    calibration.right_from_left.linear() =
        Eigen::AngleAxisd(0.04, Eigen::Vector3d(0.3, 1.0, 0.2).normalized()).toRotationMatrix();
    calibration.right_from_left.translation() = Eigen::Vector3d(-0.12, 0.003, 0.002);
    compute_rectification(calibration, 0);
    return calibration;
}

std::size_t bytes_per_line(const Options& options) {
    const auto width = static_cast<std::size_t>(options.width_px);
    return options.format == PixelFormat::yuyv ? 2 * width : width;
}

void run(const Options& options) {
    const EglContext context;
    const ShaderLibrary library;
    const StereoCalibration calibration = toed_in_pair(options);
    const cv::Size size(options.width_px, options.height_px);
    CameraIntake left_intake(context, library, size), right_intake(context, library, size);
    RectifyPass rectify_left(library, calibration, Side::left),
        rectify_right(library, calibration, Side::right);
    const cv::Size matched = reduced_size(size, options.match_width_px);
    std::optional<ReducePass> reduce_left, reduce_right;
    if (matched != size)
        for (auto* reduce : {&reduce_left, &reduce_right}) reduce->emplace(library, size, matched);
    const auto preset = parse_preset(options.preset);
    const std::string name = options.matcher.empty() ? default_matcher(preset) : options.matcher;
    const auto matcher = make_matcher(name, library,
                                      {.width_px = matched.width,
                                       .height_px = matched.height,
                                       .disparities = options.disparities,
                                       .preset = preset,
                                       .of_stream = true});
    TemporalPass temporal(library, matched.width, matched.height);
    Readback readback;

    const std::vector<std::byte> bytes(static_cast<std::size_t>(size.area()) * 2);
    LentPicture picture;
    picture.raw = {options.format, options.width_px, options.height_px, bytes_per_line(options),
                   bytes};
    picture.view = cv::Rect({0, 0}, size);
    for (int frame = 0; frame < options.frames; ++frame) {
        matcher->set_profiling(frame + 1 == options.frames);
        std::cerr << "RIG_FRAME " << frame << std::endl;
        const Texture& left = rectify_left.rectify(left_intake.planes(picture));
        const Texture& right = rectify_right.rectify(right_intake.planes(picture));
        const Texture& matched_left = reduce_left ? reduce_left->reduce(left) : left;
        const Texture& matched_right = reduce_right ? reduce_right->reduce(right) : right;
        readback.begin(temporal.run(matcher->match(matched_left, matched_right), matched_left));
        (void)readback.take();
    }
    std::cerr << "RIG_FRAME end" << std::endl;

    // What the passes outside of the matcher read and write, each texel counted once.
    const auto pixels = static_cast<std::size_t>(size.area());
    const std::size_t camera_bytes =
        planes_of(picture.raw).size() == 2
            ? pixels * 3 / 2
            : bytes_per_line(options) * static_cast<std::size_t>(options.height_px);
    auto passes = nlohmann::ordered_json::array();
    const double raw_bytes_per_pixel =
        static_cast<double>(camera_bytes) / static_cast<double>(pixels);
    passes.push_back({{"name", "rectify"},
                      {"bytes_moved", rectify_left.bytes_moved(raw_bytes_per_pixel) +
                                          rectify_right.bytes_moved(raw_bytes_per_pixel)}});
    if (reduce_left)
        passes.push_back(
            {{"name", "reduce"}, {"bytes_moved", 2 * reduce_left->cost().bytes_moved}});
    for (const PassReport& pass : matcher->passes())
        passes.push_back({{"name", pass.name},
                          {"gpu_ms", pass.gpu_ms},
                          {"bytes_moved", pass.bytes_moved},
                          {"operations", pass.operations}});
    passes.push_back({{"name", "temporal"}, {"bytes_moved", matched.area() * 16}});
    std::cout << nlohmann::ordered_json{{"renderer", GlInfo::query().renderer},
                                        {"width_px", matched.width},
                                        {"height_px", matched.height},
                                        {"colour_width_px", options.width_px},
                                        {"colour_height_px", options.height_px},
                                        {"disparities", options.disparities},
                                        {"preset", options.preset},
                                        {"matcher", name},
                                        {"frames", options.frames},
                                        {"format", fourcc_text(fourcc_of(options.format))},
                                        {"passes", passes}}
                     .dump(2)
              << "\n";
}

int main_of(int argc, char** argv) {
    Options options;
    std::string size = "640x400", format = "nv12";
    CLI::App program{"The GPU work of a rig's frame, pass by pass"};
    program.add_option("--size", size, "WIDTHxHEIGHT of the pictures");
    program.add_option("--match-width", options.match_width_px,
                       "Reduce the pictures to this width before they are matched");
    program.add_option("--disparities", options.disparities, "Search range in pixels");
    program.add_option("--preset", options.preset, "fast, balanced or quality");
    program.add_option("--matcher", options.matcher, "Matcher in place of the preset's");
    program.add_option("--frames", options.frames, "Frames of the stream")
        ->check(CLI::Range(2, 1000));
    program.add_option("--format", format, "Camera format: nv12 or yuyv")
        ->check(CLI::IsMember({"nv12", "yuyv"}));
    CLI11_PARSE(program, argc, argv);
    if (std::sscanf(size.c_str(), "%dx%d", &options.width_px, &options.height_px) != 2)
        fail("'{}' is no size: write WIDTHxHEIGHT, such as 640x400", size);
    if (format == "yuyv") options.format = PixelFormat::yuyv;
    run(options);
    return 0;
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    return vantage::run_bench("rig_frame", [&] { return vantage::main_of(argc, argv); });
}
