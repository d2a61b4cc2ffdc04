#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "calib_tools/colour/colour_match.h"
#include "calib_tools/colour/overlap.h"
#include "calib_tools/commands/snapshots.h"
#include "calib_tools/report/calibration_text.h"
#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/colour/colour_file.h"
#include "common/image/image_file.h"
#include "common/image/picture_list.h"

namespace vantage {
namespace {

struct ColourOptions {
    std::vector<std::string> rigs, charts;
    LiveOption live;
    std::string reference, output;
    long long instant = -1;
    bool json = false;
};

struct Result {
    std::vector<std::string> names;
    std::string reference;
    std::vector<ColourMatch::Camera> cameras;
};

/// Matches each rig to the true colours of the chart.
Result from_charts(const ColourOptions& options) {
    Result result;
    result.reference = "chart";
    for (const RigFolder& rig : parse_rig_folders(options.charts)) {
        std::vector<ColourPatch> patches;
        std::size_t pictures = 0;
        for (const std::filesystem::path& file : expand_pictures(rig.folder.string())) {
            ++pictures;
            const auto found = find_chart(read_colour_image(file));
            if (found)
                patches.insert(patches.end(), found->begin(), found->end());
            else
                log_warning("rig {}: {} shows no chart of 24 patches", rig.name,
                            file.filename().string());
        }
        if (patches.empty())
            fail(
                "rig {}: none of its {} pictures shows a chart of 24 patches: hold it upright, "
                "evenly lit, as large as a third of the picture",
                rig.name, pictures);
        result.names.push_back(rig.name);
        result.cameras.push_back(match_chart(patches));
    }
    return result;
}

/// Matches all rigs to one of them, by surfaces that two rigs see.
Result from_overlap(const ColourOptions& options) {
    constexpr int places = 4000;
    Result result;
    std::vector<OverlapView> views;
    for (const RigSnapshot& rig :
         take_snapshots(parse_rig_folders(options.rigs), options.live, options.instant)) {
        views.push_back(rig.overlap_view());
        result.names.push_back(rig.name);
    }
    if (views.size() < 2) fail("colours are matched between rigs: give at least two with --rig");
    result.reference = options.reference.empty() ? result.names.front() : options.reference;
    const auto reference = std::find(result.names.begin(), result.names.end(), result.reference);
    if (reference == result.names.end())
        fail("--reference {} is none of the rigs given", result.reference);
    const ColourMatch match =
        match_colours(static_cast<int>(views.size()), same_surface(overlap_samples(views, places)),
                      static_cast<int>(reference - result.names.begin()));
    result.cameras = match.cameras;
    for (std::size_t i = 0; i < result.cameras.size(); ++i)
        if (result.cameras[i].samples == 0)
            fail(
                "rig {} sees no surface that another rig sees too: give pictures with something "
                "large in the middle of the stage, or use a chart (--chart)",
                result.names[i]);
    return result;
}

void run(const ColourOptions& options) {
    if (options.rigs.empty() == options.charts.empty())
        fail("give either --rig (colours from what rigs see of one another) or --chart");
    const Result result = options.charts.empty() ? from_overlap(options) : from_charts(options);
    make_folder(options.output);
    nlohmann::json rigs = nlohmann::json::array();
    std::string text;
    for (std::size_t i = 0; i < result.names.size(); ++i) {
        const ColourMatch::Camera& camera = result.cameras[i];
        const std::filesystem::path file =
            std::filesystem::path(options.output) / (result.names[i] + ".colour.toml");
        save_colour(file, camera.correction,
                    {date_now(), "vantage-calib colour", result.reference, camera.delta_e_before,
                     camera.delta_e_after, camera.samples});
        log_info("{} written", file.string());
        nlohmann::json matrix = nlohmann::json::array();
        for (int r = 0; r < 3; ++r)
            matrix.push_back({camera.correction.matrix(r, 0), camera.correction.matrix(r, 1),
                              camera.correction.matrix(r, 2)});
        const Eigen::Vector3d& tone = camera.correction.tone;
        rigs.push_back({{"name", result.names[i]},
                        {"file", file.string()},
                        {"matrix", matrix},
                        {"tone", {tone[0], tone[1], tone[2]}},
                        {"delta_e_before", camera.delta_e_before},
                        {"delta_e_after", camera.delta_e_after},
                        {"samples", camera.samples}});
        text += fmt::format("{}: CIEDE2000 {:.2f} before, {:.2f} after, from {} places\n",
                            result.names[i], camera.delta_e_before, camera.delta_e_after,
                            camera.samples);
    }
    if (options.json)
        std::cout << nlohmann::json{{"reference", result.reference}, {"rigs", rigs}}.dump(2)
                  << '\n';
    else
        std::cout << text;
}

}  // namespace

CommandEntry colour_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command = program.add_subcommand("colour",
                                                   "Match the colours of all rigs, with a colour "
                                                   "chart or with surfaces that two rigs see");
        const auto options = std::make_shared<ColourOptions>();
        command->add_option("--rig", options->rigs,
                            "Folder of a rig, given as NAME=FOLDER, with calibration.yaml that "
                            "`stage` has placed, left*N.png and right*N.png, raw pictures of one "
                            "moment; repeat the option for each rig");
        options->live.add_to(*command);
        command->add_option("--chart", options->charts,
                            "Pictures of a chart of 24 patches before the rig NAME, given as "
                            "NAME='PATTERN'; repeat the option for each rig");
        command->add_option("--reference", options->reference,
                            "Match the other rigs to the colours of this rig (default: the first)");
        command->add_option("--instant", options->instant,
                            "Use the pictures with this number (default: each rig's first)");
        command
            ->add_option("-o,--output", options->output,
                         "Write NAME.colour.toml for each rig to this folder")
            ->required();
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
