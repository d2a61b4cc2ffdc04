// What the virtual stage costs and looks like: the processor's time to make it and to film it, and
// a strip of pictures along time, a row for every rig.
#include <chrono>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "common/base/time/time.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/shader_library.h"
#include "common/image/image_file.h"
#include "common/virtual_stage/virtual_rig.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/run_bench.h"

namespace vantage {
namespace {

struct Options {
    int width_px = 320, height_px = 240, frames = 50, columns = 10;
    double seconds = 20, sigma = 1;
    std::vector<double> azimuths_deg = {-30, 10};
    std::uint64_t set = 0;
    std::string strip;
};

/// Time on the wall and of the processor since it was made, in milliseconds.
class Stopwatch {
  public:
    std::string read() const {
        const std::chrono::duration<double, std::milli> wall = MonotonicClock::now() - start_;
        return fmt::format("{:8.1f} ms, {:8.1f} ms of processor", wall.count(), cpu_ms() - cpu_ms_);
    }
    double processor_ms() const { return cpu_ms() - cpu_ms_; }

  private:
    MonotonicTime start_ = MonotonicClock::now();
    double cpu_ms_ = cpu_ms();
};

VirtualRig rig_at(const Options& options, double azimuth_deg) {
    return VirtualRig(ideal_virtual_rig({.azimuth_rad = azimuth_deg * std::numbers::pi / 180,
                                         .width_px = options.width_px,
                                         .height_px = options.height_px}),
                      {.sigma = options.sigma}, false);
}

void run(const Options& options) {
    const EglContext context;
    const ShaderLibrary shaders;
    const Stopwatch start;
    VirtualStage stage(shaders, options.set);
    fmt::print("the stage made        {}\n", start.read());
    const TaiTime now = TaiClock::now();
    const auto time_of = [&](double seconds) {
        return now.time_since_epoch() +
               std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
    };
    const VirtualRig rig = rig_at(options, options.azimuths_deg.front());
    (void)rig.render(stage, time_of(0), 0);
    fmt::print("the first stereo pair {}\n", start.read());
    const Stopwatch steady;
    for (int frame = 0; frame < options.frames; ++frame)
        (void)rig.render(stage, time_of(0.1 * frame), static_cast<std::uint64_t>(frame));
    fmt::print("a stereo pair         {:.2f} ms of processor (mean of {})\n",
               steady.processor_ms() / options.frames, options.frames);
    if (options.strip.empty()) return;
    std::vector<cv::Mat> rows;
    for (const double azimuth_deg : options.azimuths_deg) {
        const VirtualRig filming = rig_at(options, azimuth_deg);
        std::vector<cv::Mat> pictures;
        for (int column = 0; column < options.columns; ++column)
            pictures.push_back(
                filming.render(stage, time_of(options.seconds * column / options.columns), 0).left);
        cv::hconcat(pictures, rows.emplace_back());
    }
    cv::Mat strip;
    cv::vconcat(rows, strip);
    write_colour_image(options.strip, strip);
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    vantage::Options options;
    CLI::App program("What the virtual stage costs and looks like");
    program.add_option("--set", options.set, "0: the show; others: generated sets");
    program.add_option("--width", options.width_px, "of a picture, in pixels");
    program.add_option("--height", options.height_px);
    program.add_option("--frames", options.frames, "to take the mean of");
    program.add_option("--strip", options.strip, "a picture of pictures along time");
    program.add_option("--seconds", options.seconds, "that the strip shows");
    program.add_option("--columns", options.columns, "of the strip");
    program.add_option("--azimuths", options.azimuths_deg, "of the strip's rigs, in degrees");
    CLI11_PARSE(program, argc, argv);
    return vantage::run_bench("stage_bench", [&] { vantage::run(options); });
}
