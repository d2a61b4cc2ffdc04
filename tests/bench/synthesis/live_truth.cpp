// What the programme's pictures are worth: the virtual stage tells what a real camera in the
// virtual one's place would have seen.
#include <iostream>

#include <CLI/CLI.hpp>

#include "common/gl/context/egl_context.h"
#include "host_app/synthesis/synthesiser.h"
#include "tests/bench/support/markdown_tables.h"
#include "tests/bench/support/size_option.h"
#include "tests/bench/synthesis/background_truth.h"
#include "tests/bench/synthesis/played_truth.h"
#include "tests/bench/synthesis/stepped_truth.h"

int main(int argc, char** argv) {
    using namespace vantage;
    CLI::App app("How close the programme's pictures come to a real camera's");
    app.require_subcommand(1);
    SteppedTruth stepped;
    std::string size = "320x240", preset = "balanced";
    CLI::App* steps =
        app.add_subcommand("stepped", "Every instant is waited for, at a fixed level");
    steps->add_option("--synth", stepped.synthesisers)->delimiter(',')->capture_default_str();
    steps
        ->add_option("--scenes", stepped.scenes,
                     "0: the demo's; with 1000000 added, performers wear plain colours")
        ->delimiter(',');
    steps->add_option("--rig-size", size, "Of the rigs' and of the virtual pictures");
    steps->add_option("--preset", preset, "Of the rigs' matchers");
    steps->add_option("--disparities", stepped.rigs.disparities);
    steps->add_option("--match-width", stepped.rigs.match_width_px,
                      "Of the pairs that are matched; 0: that of the rigs");
    steps
        ->add_option("--jpeg-quality", stepped.rigs.jpeg_quality,
                     "Of the rigs' colour; 0: it is not packed")
        ->check(CLI::Range(0, 100));
    std::string chroma(name_of(stepped.rigs.chroma));
    steps->add_option("--chroma", chroma, "4:4:4, 4:2:2 or 4:2:0")->capture_default_str();
    steps->add_option("--apart", stepped.apart_deg, "Degrees between two rigs");
    steps->add_option("--rate", stepped.rate_hz, "Instants a second")
        ->check(CLI::Range(0.5, 100.0));
    steps->add_option("--settling", stepped.settling_s, "Seconds before the measured ones");
    steps->add_option("--seconds", stepped.measured_s, "Measured");
    steps->add_option("--start", stepped.start_s, "In the stage's loop of 24 s");
    steps
        ->add_option("--cameras", stepped.cameras,
                     "Where cameras stand: distances between two rigs from the middle of the four; "
                     "-1.5,-0.5,0.5,1.5: where the rigs stand")
        ->delimiter(',');
    steps->add_option("--prepare-level", stepped.prepare_level)
        ->check(CLI::Range(0, prepare_levels().back().rank));
    steps->add_option("--render-level", stepped.render_level)
        ->check(CLI::Range(0, render_levels().back().rank));
    steps->add_flag("--exact", stepped.with_exact_depth, "Depth of the stage, not of the matchers");
    std::vector<std::string> exact_in;
    steps->add_option("--exact-in", exact_in, "Regions in which depth is the stage's")
        ->delimiter(',');
    steps->add_flag("--known-background", stepped.knows_background,
                    "Begin with a background that was learnt over the stage's loop");
    steps->add_flag("--regions", stepped.with_regions,
                    "Per cent of the pixels and of the squared error, by region");
    bool without_times = false;
    steps->add_flag("--without-times", without_times, "Only what does not depend on the machine");
    steps
        ->add_option("--flight", stepped.flight,
                     "Flight file: one camera of 480x270 flies its move, and none stands still")
        ->check(CLI::ExistingFile);
    steps->add_option("--pictures", stepped.pictures, "Folder for pictures beside their truth");
    BackgroundTruth wanted_background;
    CLI::App* background =
        app.add_subcommand("background", "How accurate the depth of a background is");
    background->add_option("--scenes", wanted_background.scenes, "0: the demo's")->delimiter(',');
    background->add_option("--rig-size", size, "Of the rigs");
    background->add_option("--preset", preset, "Of the rigs' matchers");
    background->add_option("--disparities", wanted_background.rigs.disparities);
    background->add_option("--apart", wanted_background.apart_deg, "Degrees between two rigs");
    background->add_option("--rate", wanted_background.rate_hz, "Instants a second");
    background->add_option("--seconds", wanted_background.seconds,
                           "That the background is learnt for");
    background->add_option("--pictures", wanted_background.pictures,
                           "Folder for pictures of the error");
    PlayedTruth played;
    CLI::App* play = app.add_subcommand("live", "The demo as it is, governed, in real time");
    play->add_option("--rate", played.rate_hz, "Pictures a second")->check(CLI::Range(1.0, 240.0));
    play->add_option("--seconds", played.seconds)->check(CLI::Range(6.0, 3600.0));
    play->add_option("--settling", played.settling_s, "Seconds before the measured ones");
    play->add_option("--quality", played.quality, "As vantage live takes it");
    play->add_option("--strip", played.strip, "Picture file: some pictures above their truth");
    std::string document;
    play->add_option("--write", document,
                     "Document that takes the tables, docs/results/live.md for example")
        ->check(CLI::ExistingFile);
    CLI11_PARSE(app, argc, argv);
    try {
        if (play->parsed()) {
            const std::string table = played_table(played);
            std::cout << table;
            if (!document.empty()) put_between_markers(document, table);
            return 0;
        }
        EglContext context;
        const ShaderLibrary shaders;
        if (background->parsed()) {
            wanted_background.rigs.size = size_of(size);
            wanted_background.rigs.preset = parse_preset(preset);
            std::cout << background_table(shaders, wanted_background);
            return 0;
        }
        stepped.with_times = !without_times;
        for (const std::string& region : exact_in)
            stepped.exact_in.push_back(parse_truth_region(region));
        stepped.rigs.size = size_of(size);
        stepped.rigs.chroma = parse_chroma(chroma);
        stepped.rigs.preset = parse_preset(preset);
        std::cout << stepped_table(shaders, stepped);
    } catch (const std::exception& error) {
        std::cerr << "live_truth: " << error.what() << "\n";
        return 1;
    }
}
