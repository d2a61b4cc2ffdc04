#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/print_result.h"
#include "common/base/files/output_path.h"
#include "common/config/calibration_file.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/image/image_file.h"
#include "common/rectification/rectify_pass.h"

namespace vantage {
namespace {

struct RectifyOptions {
    std::string calibration, left, right, out_left, out_right;
    bool json = false;
};

void check_outputs(const RectifyOptions& options) {
    require_picture_extension(options.out_left);
    require_picture_extension(options.out_right);
    require_writable_output(options.out_left,
                            {options.calibration, options.left, options.right, options.out_right});
    require_writable_output(options.out_right, {options.calibration, options.left, options.right});
}

ColourImage rectify(const ShaderLibrary& shaders, const StereoCalibration& calibration, Side side,
                    const ColourImage& raw) {
    Texture texture(TextureFormat::rgba8, raw.cols, raw.rows);
    texture.upload(raw);
    RectifyPass pass(shaders, calibration, side);
    return pass.rectify(texture).download();
}

std::vector<double> numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

void run(const RectifyOptions& options) {
    check_outputs(options);
    const StereoCalibration calibration = load_calibration(options.calibration);
    const auto [raw_left, raw_right] = read_colour_pair(options.left, options.right);

    const EglContext context;
    const GlInfo gl = GlInfo::query();
    gl.require_vantage_minimum();
    const ShaderLibrary shaders;
    // Both images are computed before either is written, so that a pair is replaced as a whole.
    const ColourImage left = rectify(shaders, calibration, Side::left, raw_left);
    const ColourImage right = rectify(shaders, calibration, Side::right, raw_right);
    write_colour_image(options.out_left, left);
    write_colour_image(options.out_right, right);

    const RectifiedStereo& geometry = calibration.rectified;
    const Pose place = calibration.world_from_rectified_left();
    print_result(
        {
            {"calibration", calibration.id},
            {"width", geometry.width_px},
            {"height", geometry.height_px},
            {"f_px", geometry.f_px},
            {"cx_left_px", geometry.cx_left_px},
            {"cx_right_px", geometry.cx_right_px},
            {"cy_px", geometry.cy_px},
            {"baseline_m", geometry.baseline_m},
            {"doffs_px", geometry.doffs_px()},
            {"position_m", numbers(place.translation())},
            {"looks_along", numbers(place.linear().col(2))},
            {"place_is_assumed", calibration.place_is_assumed},
            {"renderer", gl.renderer},
            {"out_left", options.out_left},
            {"out_right", options.out_right},
        },
        options.json);
}

}  // namespace

CommandEntry rectify_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command = program.add_subcommand(
            "rectify",
            "Rectify one pair with a calibration, by the same GPU code as the rig daemon");
        const auto options = std::make_shared<RectifyOptions>();
        command->add_option("left", options->left, "Raw left picture")->required();
        command->add_option("right", options->right, "Raw right picture")->required();
        command
            ->add_option("--calibration", options->calibration,
                         "Rectify with this calibration file (YAML)")
            ->required();
        command
            ->add_option("--out-left", options->out_left,
                         "Write the rectified left picture to this file")
            ->required();
        command
            ->add_option("--out-right", options->out_right,
                         "Write the rectified right picture to this file")
            ->required();
        command->add_flag("--json", options->json, "Print the result as one JSON object");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
