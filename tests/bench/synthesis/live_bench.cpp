// What preparing an instant and rendering a view of it cost at every level of quality: replays
// instants of the virtual stage from memory, on one context, with nothing else running.
#include <algorithm>
#include <functional>
#include <iostream>
#include <numbers>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/gpu_timer.h"
#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/depth_view.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/run_bench.h"
#include "tests/bench/support/size_option.h"

namespace vantage {
namespace {

struct BenchRig {
    StageCamera film;  ///< the rectified left one
    RectifiedStereo geometry;
};

BenchRig rig_at(double azimuth_deg, cv::Size size) {
    const StereoCalibration rig =
        ideal_virtual_rig({.azimuth_rad = azimuth_deg * std::numbers::pi / 180,
                           .width_px = size.width,
                           .height_px = size.height});
    return {{size.width, size.height, rig.left.K(), rig.world_from_left}, rig.rectified};
}

/// The median of some runs.
struct Cost {
    std::vector<double> wall_ms, cpu_ms;

    void run(const std::function<void()>& work) {
        const double before_ms = vantage::cpu_ms();
        wall_ms.push_back(median_gpu_ms(1, work));
        cpu_ms.push_back(vantage::cpu_ms() - before_ms);
    }
    static double median(std::vector<double> values) {
        std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                         values.end());
        return values[values.size() / 2];
    }
    std::string text() const {
        return fmt::format("{:.1f} / {:.1f}", median(wall_ms), median(cpu_ms));
    }
};

struct Options {
    std::vector<std::size_t> rigs{1, 2, 4, 8, 16};
    std::string rig_size = "320x240", output_size = "480x270", synthesiser = default_synthesiser;
    double rate_hz = 0;  ///< 0: not asked
    int repeats = 5;
};

/// The best level of which the median fits into a tick.
std::string level_within(double tick_ms, const std::vector<Cost>& levels) {
    for (std::size_t level = 0; level < levels.size(); ++level)
        if (Cost::median(levels[level].wall_ms) <= tick_ms) return std::to_string(level);
    return "none";
}

std::string table(const Options& options) {
    EglContext context;
    ShaderLibrary shaders;
    VirtualStage stage(shaders);
    const cv::Size rig_size = size_of(options.rig_size), output = size_of(options.output_size);
    const SynthesiserEntry entry = find_synthesiser(options.synthesiser);
    std::string text = fmt::format(
        "`{}`, rigs of {}, pictures of {}, {}. Wall / CPU milliseconds, medians of {}.\n\n"
        "| rigs | take |",
        options.synthesiser, options.rig_size, options.output_size, GlInfo::query().renderer,
        options.repeats);
    for (const PrepareLevel& level : prepare_levels())
        text += fmt::format(" prepare {} |", level.rank);
    for (const RenderLevel& level : render_levels())
        text += fmt::format(" render {} |", level.rank);
    if (options.rate_hz > 0) text += fmt::format(" renders at {:g} Hz |", options.rate_hz);
    text += "\n| --- | --- |";
    const std::size_t asked = options.rate_hz > 0 ? 1 : 0;
    for (std::size_t i = 0; i < prepare_levels().size() + render_levels().size() + asked; ++i)
        text += " --- |";
    text += "\n";

    const std::size_t most = *std::max_element(options.rigs.begin(), options.rigs.end());
    constexpr int instants = 3;
    std::vector<std::vector<DepthView>> films(instants);
    for (int i = 0; i < instants; ++i)
        for (std::size_t rig = 0; rig < most; ++rig) {
            const BenchRig camera = rig_at(
                20.0 * (static_cast<double>(rig) - 0.5 * static_cast<double>(most - 1)), rig_size);
            StageRendering seen =
                stage.render(camera.film, std::chrono::milliseconds(2000 + 100 * i));
            // As it would have come over the wire.
            RigFrame frame;
            frame.rig = std::to_string(rig);
            frame.geometry = camera.geometry;
            frame.world_from_camera = camera.film.world_from_camera;
            frame.colour = seen.colour;
            frame.disparity = disparity_from_depth(seen.depth_m, camera.geometry);
            films[static_cast<std::size_t>(i)].push_back(depth_view_of(frame));
        }
    for (const std::size_t rigs : options.rigs) {
        const auto preparer = entry.make_preparer(shaders);
        const auto renderer = entry.make_renderer(shaders);
        const auto view_at = [&](double scale) {
            const cv::Size size(cvRound(output.width * scale), cvRound(output.height * scale));
            const StageCamera camera = rig_at(3, size).film;
            return VirtualView{size.width, size.height, camera.K, camera.world_from_camera};
        };
        // As after some seconds: the background is known and baked.
        const auto known = std::span(films.front()).subspan((most - rigs) / 2, rigs);
        for (std::size_t i = 0; i < 4 * rigs; ++i) {
            preparer->take(known, 1);
            (void)preparer->prepare(view_at(1), prepare_levels()[1]);
            preparer->improve(view_at(1));
        }
        Cost take;
        std::vector<Cost> prepare(prepare_levels().size()), render(render_levels().size());
        for (int i = -1; i < options.repeats; ++i) {
            const auto& all = films[static_cast<std::size_t>(i + instants) % instants];
            const auto first = (most - rigs) / 2;
            const auto views = std::span(all).subspan(first, rigs);
            const auto count = [&](Cost& cost, const std::function<void()>& work) {
                Cost unused;
                (i < 0 ? unused : cost).run(work);
            };
            std::shared_ptr<const Instant> instant;
            for (std::size_t level = 0; level < prepare.size(); ++level) {
                count(take, [&] { preparer->take(views, 0.1); });
                count(prepare[level],
                      [&] { instant = preparer->prepare(view_at(1), prepare_levels()[level]); });
            }
            for (const RenderLevel& level : render_levels()) {
                const VirtualView view = view_at(level.scale);
                count(render[static_cast<std::size_t>(level.rank)],
                      [&] { renderer->render(*instant, view, level); });
            }
        }
        text += fmt::format("| {} | {} |", rigs, take.text());
        for (const Cost& cost : prepare) text += " " + cost.text() + " |";
        for (const Cost& cost : render) text += " " + cost.text() + " |";
        if (options.rate_hz > 0)
            text += fmt::format(" {} |", level_within(1000 / options.rate_hz, render));
        text += "\n";
    }
    return text;
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    vantage::Options options;
    CLI::App app("Cost of preparing and rendering at every level of quality");
    app.add_option("--rigs", options.rigs, "How many rigs, one row each")->delimiter(',');
    app.add_option("--rig-size", options.rig_size, "Of colour and depth");
    app.add_option("--size", options.output_size, "Of the picture");
    app.add_option("--synth", options.synthesiser, "The synthesiser");
    app.add_option("--rate", options.rate_hz,
                   "Pictures a second: says the best level whose rendering fits into a tick")
        ->check(CLI::Range(0.1, 1000.0));
    app.add_option("--repeats", options.repeats, "Of which the medians are taken")
        ->check(CLI::Range(1, 1000));
    CLI11_PARSE(app, argc, argv);
    return vantage::run_bench("live_bench", [&] { std::cout << vantage::table(options); });
}
