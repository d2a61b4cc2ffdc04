#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/print_result.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/output_path.h"
#include "host_app/camera_paths/camera_path.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/session/options/common_options.h"

namespace vantage {
namespace {

constexpr double rad = std::numbers::pi / 180;

struct MoveOptions {
    std::string from, to, rate, size = "1920x1080";
    double tolerance_mm = 10, tolerance_deg = 0.1, focus_m = 4.5, field_of_view_deg = 0;
    bool json = false;
};

bool is_flight_file(const std::filesystem::path& file) { return file.extension() == ".toml"; }

void convert(const MoveOptions& options) {
    const std::filesystem::path from = options.from, to = options.to;
    std::optional<double> rate_hz;
    if (!options.rate.empty()) rate_hz = parse_rate(options.rate);
    const cv::Size size_px = parse_size(options.size);
    require_writable_output(to, {from});
    if (std::filesystem::exists(to)) fail("{} exists; give another name", to.string());
    if (is_flight_file(from) && is_flight_file(to))
        fail("{} and {} are both flight files; there is nothing to convert", from.string(),
             to.string());
    nlohmann::ordered_json result{{"path", to.string()}};
    CameraPath path;
    if (is_flight_file(from)) {
        path = sampled(Move::load(from), rate_hz.value_or(default_camera_rate_hz), size_px);
    } else {
        CameraPathSettings settings{rate_hz, size_px, options.focus_m};
        if (options.field_of_view_deg > 0)
            settings.field_of_view_rad = options.field_of_view_deg * rad;
        path = form_of(from).read(from, settings);
    }
    result["cameras"] = path.cameras.size();
    result["rate_hz"] = path.rate_hz;
    result["duration_s"] = static_cast<double>(path.cameras.size() - 1) / path.rate_hz;
    if (is_flight_file(to)) {
        constexpr double mm = 1000;
        const FlightTolerance tolerance{options.tolerance_mm / mm, options.tolerance_deg * rad};
        const SimplifiedFlight flight = move_along(path, tolerance);
        FlightBook book;
        book.lowest_m = flight.move.limits().min_eye_height_m;
        book.move = flight.move;
        const std::string text = to_toml(book);
        write_text_atomically(to, text);
        result["keyframes"] = flight.move.keyframes().size();
        result["worst_mm"] = flight.worst * options.tolerance_mm;
        result["worst_deg"] = flight.worst * options.tolerance_deg;
    } else {
        form_of(to).write(path, to);
    }
    print_result(result, options.json);
}

}  // namespace

CommandEntry move_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<MoveOptions>();
        CLI::App* move = program.add_subcommand("move", "Moves of the virtual camera");
        move->require_subcommand(1);
        CLI::App* command = move->add_subcommand(
            "convert", "Convert a move to and from the formats of other programs");
        std::string forms = "NAME.toml, a flight file";
        for (const CameraPathForm& form : camera_path_forms()) forms += "; " + form.words;
        command->add_option("FROM", options->from, forms)->required();
        command->add_option("-o,--output", options->to, "Write this file, which must not exist")
            ->required();
        command->add_option(
            "--rate", options->rate,
            "Set the cameras per second of a format other than a flight file (default: the file's "
            "if it states it, else 25)");
        command
            ->add_option("--size", options->size,
                         "Set the size of the picture, WIDTHxHEIGHT, for formats that need it")
            ->capture_default_str();
        command
            ->add_option("--tolerance-mm", options->tolerance_mm,
                         "Set the largest distance between a new move and the cameras")
            ->check(CLI::Range(0.01, 1000.0))
            ->capture_default_str();
        command
            ->add_option("--tolerance-deg", options->tolerance_deg,
                         "Set the largest difference in rotation and field of view")
            ->check(CLI::Range(0.001, 10.0))
            ->capture_default_str();
        command
            ->add_option("--focus-m", options->focus_m,
                         "Set the distance of the pivot, for formats without one")
            ->check(CLI::Range(0.05, 100.0))
            ->capture_default_str();
        command
            ->add_option("--fov", options->field_of_view_deg,
                         "Set the horizontal field of view in degrees instead of the file's")
            ->check(CLI::Range(5.0, 114.0));
        command->add_flag("--json", options->json, "Print the result as one JSON object");
        command->callback([options] { convert(*options); });
    }};
}

}  // namespace vantage
