// How long a past fits into the replay buffer: frames of the virtual stage as full-size rigs send
// them, colour with the sensors' noise and the depth of the rigs' own matcher, kept as they came.
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "common/gl/context/egl_context.h"
#include "common/wire/frame_codec.h"
#include "host_app/frames/replay_buffer.h"
#include "tests/bench/scale/full_size_frames.h"
#include "tests/bench/support/run_bench.h"

namespace vantage {
namespace {

struct Wanted {
    FullSizeFrames frames;
    double rate_hz = 30, seconds = 20, past_mb = 1000;
};

void measure(const ShaderLibrary& library, const Wanted& wanted) {
    constexpr double places_deg[] = {-30, -10, 10, 30};
    std::vector<std::vector<PackedFrame>> rigs;
    double colour = 0, disparity = 0, frames = 0;
    for (const double azimuth_deg : places_deg) {
        rigs.push_back(film_full_size(library, wanted.frames, azimuth_deg, rigs.size() + 1));
        for (const PackedFrame& frame : rigs.back()) {
            colour += static_cast<double>(frame.colour.size());
            disparity += static_cast<double>(frame.disparity.size());
            ++frames;
        }
    }
    ReplayBuffer past(static_cast<std::size_t>(wanted.past_mb * 1e6));
    const auto pulses = static_cast<std::uint64_t>(wanted.seconds * wanted.rate_hz);
    for (std::uint64_t pulse = 1; pulse <= pulses; ++pulse) {
        FrameSet set;
        set.trigger_index = pulse;
        for (const std::vector<PackedFrame>& rig : rigs) {
            auto frame = std::make_shared<RigFrame>();
            // Memory of its own, as of a frame that came.
            frame->packed = std::make_shared<const PackedFrame>(rig[pulse % rig.size()]);
            set.slots.push_back({"rig", std::move(frame), Absence::none});
        }
        past.add(set);
    }
    const PastFrameSets::Span span = *past.span();
    std::cout << fmt::format(
        "{} rigs, colour {} as JPEG {} of {}, depth {}, {:g} Hz, noise of {:g} grey levels: a "
        "frame has "
        "{:.0f} kB of colour and {:.0f} kB of depth.\n"
        "Of {:g} s a replay buffer of {:g} MB keeps {:.1f} s, {:.0f} MB.\n",
        rigs.size(), wanted.frames.colour, wanted.frames.jpeg_quality, wanted.frames.chroma,
        wanted.frames.depth, wanted.rate_hz, wanted.frames.noise_sigma, colour / frames / 1e3,
        disparity / frames / 1e3, wanted.seconds, wanted.past_mb,
        static_cast<double>(span.sets) / wanted.rate_hz, static_cast<double>(span.bytes) / 1e6);
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    using namespace vantage;
    CLI::App app("How long a past fits into the replay buffer");
    Wanted wanted;
    app.add_option("--colour", wanted.frames.colour, "Size of the rigs' pictures")
        ->capture_default_str();
    app.add_option("--depth", wanted.frames.depth, "Size of their depth")->capture_default_str();
    app.add_option("--rate", wanted.rate_hz, "Pulses a second")->capture_default_str();
    app.add_option("--seconds", wanted.seconds, "That are sent")->capture_default_str();
    app.add_option("--past-mb", wanted.past_mb, "Of the buffer")->capture_default_str();
    app.add_option("--jpeg-quality", wanted.frames.jpeg_quality, "1 to 100; 0: lossless")
        ->capture_default_str();
    app.add_option("--chroma", wanted.frames.chroma, "4:4:4, 4:2:2 or 4:2:0")
        ->capture_default_str();
    app.add_option("--noise", wanted.frames.noise_sigma, "Of the sensors, grey levels")
        ->capture_default_str();
    app.add_option("--instants", wanted.frames.instants, "Of the stage, which are sent in turn")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return run_bench("replay_memory", [&] {
        const EglContext context;
        const ShaderLibrary shaders;
        measure(shaders, wanted);
    });
}
