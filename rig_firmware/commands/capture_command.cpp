#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/print_result.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/config/rig_config.h"
#include "common/image/image_file.h"
#include "rig_firmware/capture/stereo_source.h"

namespace vantage {
namespace {

struct CaptureOptions {
    std::string config, folder;
    int count = 20;
    std::uint64_t every = 30;
    double patience_s = 10;
    bool json = false;
};

std::filesystem::path picture(const CaptureOptions& options, const char* side,
                              std::uint64_t index) {
    return std::filesystem::path(options.folder) / fmt::format("{}_{}.png", side, index);
}

/// Waits for the next pulse that the options keep. Returns nothing at the end of the material or
/// when the program is asked to stop. Throws Error if no pulse comes for too long.
std::optional<StereoFrame> next_kept(StereoSource& source, const CaptureOptions& options,
                                     StopSignal& stop) {
    auto heard = MonotonicClock::now();
    while (!stop.requested() && !source.ended()) {
        std::optional<StereoFrame> frame = source.next(StopSignal::look_period);
        const MonotonicTime now = MonotonicClock::now();
        if (frame) heard = now;
        if (frame && frame->trigger_index % options.every == 0) return frame;
        if (std::chrono::duration<double>(now - heard).count() > options.patience_s)
            fail("no frame came for {:g} s; are the cameras plugged in and triggered?",
                 options.patience_s);
    }
    return std::nullopt;
}

void run(const CaptureOptions& options) {
    const RigConfig config = load_rig_config(options.config);
    make_folder(options.folder);
    StopSignal stop;
    const std::unique_ptr<StereoSource> source = make_source(config);
    for (const std::string& line : source->report()) log_info("{}", line);
    nlohmann::ordered_json indices = nlohmann::ordered_json::array();
    bool synchronized = true;
    for (int i = 0; i < options.count; ++i) {
        const std::optional<StereoFrame> frame = next_kept(*source, options, stop);
        if (!frame) break;
        // The right image is written last: a pair is complete where both files exist.
        write_colour_image(picture(options, "left", frame->trigger_index), frame->left);
        write_colour_image(picture(options, "right", frame->trigger_index), frame->right);
        indices.push_back(frame->trigger_index);
        synchronized = synchronized && frame->synchronized;
        log_info("pair {} of {}: pulse {}", i + 1, options.count, frame->trigger_index);
    }
    if (indices.empty()) fail("there was no pair to keep");
    if (!synchronized)
        log_warning(
            "the frames name no pulses of the stage: equal numbers of two rigs are not equal "
            "instants");
    nlohmann::ordered_json result{{"rig", config.name},
                                  {"folder", options.folder},
                                  {"pairs", indices.size()},
                                  {"width", source->size().width},
                                  {"height", source->size().height},
                                  {"synchronized", synchronized},
                                  {"indices", indices}};
    if (source->material_rate_hz() > 0) result["material_rate_hz"] = source->material_rate_hz();
    print_result(result, options.json);
}

}  // namespace

CommandEntry capture_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command = program.add_subcommand(
            "capture", "Keep raw pairs as pictures numbered by pulse, for vantage-calib");
        const auto options = std::make_shared<CaptureOptions>();
        command->add_option("--config", options->config, "Read this rig file (rig.toml)")
            ->required();
        command
            ->add_option(
                "--every", options->every,
                "Keep the pulses whose number is a multiple of this: the same pulses at every rig")
            ->check(CLI::Range(1, 1000000))
            ->capture_default_str();
        command->add_option("--count", options->count, "Keep this many pairs")
            ->check(CLI::Range(1, 10000))
            ->capture_default_str();
        command
            ->add_option(
                "-o,--output", options->folder,
                "Write left_N.png and right_N.png to this folder; N is the number of the pulse")
            ->required();
        command->add_flag("--json", options->json, "Print the result as one JSON object");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
