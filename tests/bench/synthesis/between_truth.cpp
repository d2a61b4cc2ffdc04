// What instants between two pulses are worth, which slow motion shows: the virtual stage tells what
// the rigs, and a camera between them, would have seen.
#include <filesystem>
#include <iostream>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/image/image_file.h"
#include "host_app/foreground/motion/rig_agreement.h"
#include "host_app/foreground/motion/rig_motion.h"
#include "host_app/programme/view_painter.h"
#include "host_app/view_sets/image_metrics.h"
#include "host_app/views/depth_view.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/size_option.h"
#include "tests/bench/synthesis/matching_rig.h"

namespace vantage {
namespace {

using std::chrono::nanoseconds;

struct Wanted {
    std::vector<std::uint64_t> scenes{0, 1, 2};
    cv::Size size{320, 240};
    double rate_hz = 25, apart_deg = 20, share = 0.5, start_s = 2, apart_s = 0.7;
    /// Of a live stage; so long before the first moment the background is learnt, an instant so
    /// often.
    double learning_s = 5, learning_apart_s = 0.2;
    int moments = 6;
    bool with_exact_depth = false, with_camera = true;
    std::string pictures;
};

enum Way { nearest, blended, moved, filmed, ways };
constexpr const char* names[] = {"nearest", "blended", "along the motion", "filmed there"};

RigFrame blended_frame(const RigFrame& a, const RigFrame& b, double share) {
    RigFrame frame = a;
    cv::Mat colour;
    cv::addWeighted(a.colour, 1 - share, b.colour, share, 0, colour);
    frame.colour = colour;
    if (share >= 0.5) frame.disparity = b.disparity;
    return frame;
}

/// Squared errors by where they are.
struct Errors {
    double squares[2] = {0, 0};
    double pixels[2] = {0, 0};
    void add(const ColourImage& picture, const ColourImage& truth, const cv::Mat1b& moving) {
        for (int y = 0; y < truth.rows; ++y)
            for (int x = 0; x < truth.cols; ++x) {
                const int where = moving(y, x) ? 0 : 1;
                for (int c = 0; c < 3; ++c) {
                    const double e = picture(y, x)[c] - truth(y, x)[c];
                    squares[where] += e * e;
                }
                pixels[where] += 3;
            }
    }
    double psnr_db(int where) const {
        return 10 * std::log10(255.0 * 255.0 * pixels[where] / std::max(squares[where], 1e-9));
    }
};

/// Where a picture without noise changes between the pulses.
cv::Mat1b moving_in(const ColourImage& a, const ColourImage& b) {
    cv::Mat difference;
    cv::absdiff(a, b, difference);
    cv::Mat1b moving(a.size());
    for (int y = 0; y < a.rows; ++y)
        for (int x = 0; x < a.cols; ++x) {
            const auto d = difference.at<cv::Vec4b>(y, x);
            moving(y, x) = std::max({d[0], d[1], d[2]}) > 4 ? 255 : 0;
        }
    cv::dilate(moving, moving, cv::Mat1b::ones(5, 5));
    return moving;
}

RigFrame frame_of(const MatchingRig& rig, const StereoCalibration& calibration, bool own) {
    const DepthView view = rig.view(own);
    RigFrame frame;
    frame.rig = view.name;
    frame.colour = view.colour.clone();
    frame.geometry = calibration.rectified;
    frame.world_from_camera = calibration.world_from_left;
    frame.disparity = disparity_from_depth(view.depth_m, calibration.rectified);
    return frame;
}

struct Camera {
    CameraState state;
    StageCamera camera;
};

void measure(const ShaderLibrary& library, const Wanted& wanted) {
    std::cout << fmt::format(
        "Rigs of {}x{}, {:g} degrees apart, {:g} pulses a second, {} depth, at {:g} of the time "
        "between two; PSNR in dB of what moves and of what stands still.\n\n"
        "| scene | | rigs: moving | still | camera between: moving | still |\n"
        "| --- | --- | --- | --- | --- | --- |\n",
        wanted.size.width, wanted.size.height, wanted.apart_deg, wanted.rate_hz,
        wanted.with_exact_depth ? "exact" : "own", wanted.share);
    std::vector<double> motion_ms, agree_ms, between_ms;
    Errors all_rigs[ways], all_camera[ways];
    for (const std::uint64_t scene : wanted.scenes) {
        VirtualStage stage(library, scene), truth_stage(library, scene);
        MatchingRig::Settings settings;
        settings.size = wanted.size;
        settings.disparities = wanted.size.width / 10;
        settings.preset = MatchPreset::balanced;
        std::vector<std::unique_ptr<MatchingRig>> rigs;
        std::vector<StereoCalibration> calibrations;
        for (const double place : {-1.5, -0.5, 0.5, 1.5}) {
            rigs.push_back(std::make_unique<MatchingRig>(library, place * wanted.apart_deg,
                                                         rigs.size() + 1, settings));
            calibrations.push_back(rig_at(place * wanted.apart_deg, wanted.size));
        }
        const StereoCalibration middle = rig_at(0, wanted.size);
        Camera camera;
        camera.state.world_from_camera = middle.world_from_left;
        camera.state.field_of_view_rad =
            2 * std::atan(0.5 * wanted.size.width / middle.left.K()(0, 0));
        camera.camera = {wanted.size.width, wanted.size.height,
                         camera.state.K(wanted.size.width, wanted.size.height),
                         camera.state.world_from_camera};
        const PictureFormat format{.width_px = wanted.size.width, .height_px = wanted.size.height};
        const SynthesiserEntry entry = find_synthesiser("fused");
        struct Runner {
            std::unique_ptr<InstantPreparer> preparer;
            std::unique_ptr<ViewPainter> painter;
        };
        std::vector<Runner> runners;
        if (wanted.with_camera)
            for (int way = 0; way < ways; ++way)
                runners.push_back({entry.make_preparer(library),
                                   std::make_unique<ViewPainter>(entry, format, library)});

        Errors at_rigs[ways], at_camera[ways];
        std::uint64_t instant = 0;
        const auto film = [&](nanoseconds time) {
            std::vector<RigFrame> frames;
            for (std::size_t r = 0; r < rigs.size(); ++r) {
                rigs[r]->film(stage, time, instant);
                frames.push_back(frame_of(*rigs[r], calibrations[r], !wanted.with_exact_depth));
            }
            ++instant;
            return frames;
        };
        const auto show = [&](Runner& runner, const std::vector<RigFrame>& frames, double dt_s,
                              bool paints) {
            std::vector<DepthView> views;
            for (const RigFrame& frame : frames) views.push_back(depth_view_of(frame));
            runner.preparer->take(views, dt_s);
            const VirtualView target = view_of(camera.state, wanted.size);
            for (std::size_t rig = 0; rig < views.size(); ++rig) runner.preparer->improve(target);
            const auto ready = runner.preparer->prepare(target, prepare_levels().front());
            ColourImage picture;
            if (paints)
                picture = runner.painter->paint(*ready, camera.state, render_levels().front());
            return picture;
        };
        // Once around, so that no time is before the stage's beginning.
        constexpr double loop_s = 24;
        const auto time_of = [&](double since_start_s) {
            return nanoseconds(
                static_cast<std::int64_t>(1e9 * (loop_s + wanted.start_s + since_start_s)));
        };
        if (wanted.with_camera)
            for (double time_s = -wanted.learning_s; time_s < -wanted.learning_apart_s / 2;
                 time_s += wanted.learning_apart_s) {
                const std::vector<RigFrame> frames = film(time_of(time_s));
                for (Runner& runner : runners) show(runner, frames, wanted.learning_apart_s, false);
            }
        for (int moment = 0; moment < wanted.moments; ++moment) {
            const auto at = [&](double pulses) {
                return time_of(moment * wanted.apart_s + pulses / wanted.rate_hz);
            };
            const std::vector<RigFrame> a = film(at(0)), b = film(at(1));
            std::vector<RigFrame> between[ways];
            between[filmed] = film(at(wanted.share));
            std::vector<RigMotion> motions;
            for (std::size_t r = 0; r < rigs.size(); ++r) {
                const double start = cpu_ms();
                motions.push_back(motion_between(a[r], b[r]));
                motion_ms.push_back(cpu_ms() - start);
            }
            std::vector<FollowedRig> followed;
            for (std::size_t r = 0; r < rigs.size(); ++r)
                followed.push_back({&a[r], &b[r], &motions[r]});
            const double asked = cpu_ms();
            agree_on_motion(followed);
            agree_ms.push_back((cpu_ms() - asked) / static_cast<double>(rigs.size()));
            for (std::size_t r = 0; r < rigs.size(); ++r) {
                const VirtualRig clean(calibrations[r], {.sigma = 0}, false);
                const ColourImage before = clean.render_noiseless(stage, at(0)).left;
                const ColourImage truth = clean.render_noiseless(stage, at(wanted.share)).left;
                const ColourImage after = clean.render_noiseless(stage, at(1)).left;
                const cv::Mat1b moving = moving_in(before, after);
                between[nearest].push_back(wanted.share < 0.5 ? a[r] : b[r]);
                between[blended].push_back(blended_frame(a[r], b[r], wanted.share));
                const double start = cpu_ms();
                between[moved].push_back(frame_between(a[r], b[r], motions[r], wanted.share));
                between_ms.push_back(cpu_ms() - start);
                for (int way = 0; way < ways; ++way) {
                    at_rigs[way].add(between[way][r].colour, truth, moving);
                    all_rigs[way].add(between[way][r].colour, truth, moving);
                }
                if (!wanted.pictures.empty() && r == 1) {
                    std::filesystem::create_directories(wanted.pictures);
                    cv::Mat row;
                    cv::hconcat(
                        std::vector<cv::Mat>{truth, between[nearest][r].colour,
                                             between[blended][r].colour, between[moved][r].colour},
                        row);
                    write_colour_image(std::filesystem::path(wanted.pictures) /
                                           fmt::format("scene{}_{}_rig.png", scene, moment),
                                       ColourImage(row));
                }
            }
            if (!wanted.with_camera) continue;
            // The in-between is shown after the first pulse.
            const ColourImage before = truth_stage.render(camera.camera, at(0)).colour;
            const ColourImage truth = truth_stage.render(camera.camera, at(wanted.share)).colour;
            const ColourImage after = truth_stage.render(camera.camera, at(1)).colour;
            const cv::Mat1b moving = moving_in(before, after);
            std::vector<cv::Mat> pictures{truth};
            for (int way = 0; way < ways; ++way) {
                show(runners[static_cast<std::size_t>(way)], a, wanted.apart_s, false);
                const ColourImage picture = show(runners[static_cast<std::size_t>(way)],
                                                 between[way], wanted.share / wanted.rate_hz, true);
                at_camera[way].add(picture, truth, moving);
                all_camera[way].add(picture, truth, moving);
                pictures.push_back(picture);
            }
            if (!wanted.pictures.empty() && pictures.size() > 1) {
                cv::Mat row;
                cv::hconcat(pictures, row);
                write_colour_image(std::filesystem::path(wanted.pictures) /
                                       fmt::format("scene{}_{}_camera.png", scene, moment),
                                   ColourImage(row));
            }
        }
        for (int way = 0; way < ways; ++way)
            std::cout << fmt::format("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", scene,
                                     names[way], at_rigs[way].psnr_db(0), at_rigs[way].psnr_db(1),
                                     wanted.with_camera ? at_camera[way].psnr_db(0) : 0,
                                     wanted.with_camera ? at_camera[way].psnr_db(1) : 0);
    }
    for (int way = 0; way < ways; ++way)
        std::cout << fmt::format("| all | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", names[way],
                                 all_rigs[way].psnr_db(0), all_rigs[way].psnr_db(1),
                                 wanted.with_camera ? all_camera[way].psnr_db(0) : 0,
                                 wanted.with_camera ? all_camera[way].psnr_db(1) : 0);
    const auto median_of = [](std::vector<double> values) {
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
    };
    std::cout << fmt::format(
        "\nOf the processor, median: {:.1f} ms a rig and pair of pulses for the motion, {:.1f} ms "
        "for what rigs ask each other, {:.1f} ms a rig and instant for the frame between.\n",
        median_of(motion_ms), median_of(agree_ms), median_of(between_ms));
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    using namespace vantage;
    CLI::App app("How close instants between two pulses come to what was there");
    Wanted wanted;
    std::string size = "320x240";
    bool without_camera = false;
    app.add_option("--scenes", wanted.scenes, "0: the demo's")->delimiter(',');
    app.add_option("--rig-size", size, "Of the rigs' and of the virtual pictures");
    app.add_option("--rate", wanted.rate_hz, "Pulses a second")->capture_default_str();
    app.add_option("--apart", wanted.apart_deg, "Degrees between two rigs");
    app.add_option("--share", wanted.share, "Of the time between two pulses")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--start", wanted.start_s, "In the stage's loop of 24 s");
    app.add_option("--learn", wanted.learning_s, "Before it, from which the background is learnt")
        ->check(CLI::Range(0.0, 24.0))
        ->capture_default_str();
    app.add_option("--moments", wanted.moments, "That are looked at, 0.7 s apart");
    app.add_flag("--exact", wanted.with_exact_depth, "Depth of the stage, not of the matchers");
    app.add_flag("--rigs-only", without_camera, "No camera between the rigs");
    app.add_option("--pictures", wanted.pictures,
                   "Folder for pictures: truth, nearest, blended, along the motion; of the camera "
                   "also filmed there");
    CLI11_PARSE(app, argc, argv);
    try {
        EglContext context;
        const ShaderLibrary shaders;
        wanted.size = size_of(size);
        wanted.with_camera = !without_camera;
        measure(shaders, wanted);
    } catch (const std::exception& error) {
        std::cerr << "between_truth: " << error.what() << "\n";
        return 1;
    }
}
