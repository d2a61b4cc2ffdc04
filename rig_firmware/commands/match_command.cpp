#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/print_result.h"
#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/gpu_timer.h"
#include "common/image/colour_map.h"
#include "common/image/disparity_file.h"
#include "common/image/image_file.h"
#include "rig_firmware/stereo/features/reduce_pass.h"
#include "rig_firmware/stereo/matcher.h"
#include "rig_firmware/stereo/pi_model.h"

namespace vantage {
namespace {

std::string row(const PassReport& pass) {
    return fmt::format("{:<22}{:>6}{:>10.2f}{:>10.1f}{:>10.1f}\n", pass.name, pass.runs,
                       pass.gpu_ms, static_cast<double>(pass.bytes_moved) * 1e-6,
                       pass.operations * 1e-6);
}

/// A matcher, and before it a reduction of the pictures if less than they have is to be matched, as
/// the daemon does it for 'width_px'.
class PairMatcher {
  public:
    PairMatcher(const std::string& name, const ShaderLibrary& library, cv::Size picture,
                const MatchSettings& settings)
        : matcher_(make_matcher(name, library, settings)) {
        const cv::Size matched(settings.width_px, settings.height_px);
        if (matched == picture) return;
        reduce_left_.emplace(library, picture, matched);
        reduce_right_.emplace(library, picture, matched);
    }

    const Texture& match(const Texture& left, const Texture& right) {
        if (!reduce_left_) return matcher_->match(left, right);
        profiler_.begin_frame();
        for (ReducePass* reduce : {&*reduce_left_, &*reduce_right_})
            profiler_.run("reduce", reduce->cost(),
                          [&] { reduce->reduce(reduce == &*reduce_left_ ? left : right); });
        profiler_.end_frame();
        return matcher_->match(reduce_left_->reduced(), reduce_right_->reduced());
    }
    void set_profiling(bool on) {
        profiler_.set_enabled(on);
        matcher_->set_profiling(on);
    }
    std::vector<PassReport> passes() const {
        std::vector<PassReport> passes = profiler_.reports();
        const std::vector<PassReport> more = matcher_->passes();
        passes.insert(passes.end(), more.begin(), more.end());
        return passes;
    }
    const Texture* confidence() const { return matcher_->confidence(); }
    std::size_t gpu_bytes() const {
        return matcher_->gpu_bytes() + (reduce_left_ ? 2 * reduce_left_->gpu_bytes() : 0);
    }
    std::size_t cost_volume_bytes() const { return matcher_->cost_volume_bytes(); }

  private:
    PassProfiler profiler_;
    std::optional<ReducePass> reduce_left_, reduce_right_;
    std::unique_ptr<Matcher> matcher_;
};

/// The passes of the last match() as a table for people: runs, time, traffic, operations, their
/// sums, and what a Raspberry Pi would take by a model.
std::string pass_table(const PairMatcher& matcher) {
    std::string table =
        fmt::format("{:<22}{:>6}{:>10}{:>10}{:>10}\n", "pass", "runs", "ms", "MB moved", "M ops");
    PassReport total{.name = "total"};
    for (const PassReport& pass : matcher.passes()) {
        table += row(pass);
        total.runs += pass.runs;
        total.gpu_ms += pass.gpu_ms;
        total.bytes_moved += pass.bytes_moved;
        total.operations += pass.operations;
    }
    table += row(total);
    table += fmt::format("GL objects {:.1f} MB, of which cost volumes {:.1f} MB\n",
                         static_cast<double>(matcher.gpu_bytes()) * 1e-6,
                         static_cast<double>(matcher.cost_volume_bytes()) * 1e-6);
    return table + pi_model_lines(matcher.passes());
}

/// Median of the known disparities in pixels; 0 if none is known.
double median_px(const DisparityImage& disparity) {
    std::vector<std::uint16_t> known;
    for (const std::uint16_t d : disparity)
        if (d > 0) known.push_back(d);
    if (known.empty()) return 0;
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    return static_cast<double>(*middle) / disparity_steps_per_px;
}

struct MatchOptions {
    std::string left, right, matcher, preset = "balanced", output, colour_map, confidence;
    int disparities = 0, width_px = 0, repeats = 5;
    bool no_fill = false, explain = false, json = false;
};

/// Checks the output options that can be checked without reading an image. Throws Error.
void check_outputs(const MatchOptions& options) {
    disparity_form(options.output);
    require_writable_output(options.output, {options.left, options.right});
    if (!options.colour_map.empty()) {
        require_picture_extension(options.colour_map);
        require_writable_output(options.colour_map, {options.left, options.right, options.output});
    }
    if (!options.confidence.empty()) {
        if (std::filesystem::path(options.confidence).extension() != ".png")
            fail("{} cannot hold confidence, which is written without loss: name a .png",
                 options.confidence);
        require_writable_output(options.confidence,
                                {options.left, options.right, options.output, options.colour_map});
    }
}

Texture upload(const ColourImage& picture) {
    Texture texture(TextureFormat::rgba8, picture.cols, picture.rows);
    texture.upload(picture);
    return texture;
}

nlohmann::ordered_json passes_as_json(const PairMatcher& matcher) {
    auto passes = nlohmann::ordered_json::array();
    for (const PassReport& pass : matcher.passes())
        passes.push_back({{"name", pass.name},
                          {"runs", pass.runs},
                          {"gpu_ms", pass.gpu_ms},
                          {"bytes_moved", pass.bytes_moved},
                          {"operations", pass.operations}});
    return passes;
}

nlohmann::ordered_json modelled_frames_as_json(const PairMatcher& matcher) {
    nlohmann::ordered_json frames;
    for (const PiModel& model : pi_models)
        frames[model.name] = modelled_frame_ms(model, matcher.passes());
    return frames;
}

void match(const MatchOptions& options) {
    const MatchPreset preset = parse_preset(options.preset);
    const std::string matcher_name =
        options.matcher.empty() ? default_matcher(preset) : options.matcher;
    check_outputs(options);
    const auto [left, right] = read_colour_pair(options.left, options.right);
    if (left.size() != right.size())
        fail("{} is {}x{} and {} is {}x{}; the two pictures of a rectified pair have one size",
             options.left, left.cols, left.rows, options.right, right.cols, right.rows);
    if (options.width_px > left.cols)
        fail("--width {} is more than the pictures have, which are {} px wide", options.width_px,
             left.cols);
    const cv::Size matched = reduced_size(left.size(), options.width_px);
    const MatchSettings settings{.width_px = matched.width,
                                 .height_px = matched.height,
                                 .disparities = options.disparities,
                                 .preset = preset,
                                 .fill = !options.no_fill,
                                 .confidence = !options.confidence.empty()};
    settings.validate();

    const EglContext context;
    const GlInfo gl = GlInfo::query();
    gl.require_vantage_minimum();
    const ShaderLibrary shaders;
    PairMatcher matcher(matcher_name, shaders, left.size(), settings);
    if (settings.confidence && !matcher.confidence())
        fail("the matcher '{}' knows no confidence; leave out --confidence or take another matcher",
             matcher_name);
    const Texture left_texture = upload(left), right_texture = upload(right);
    // The first match only warms up the driver: some drivers compile shaders when they are first
    // used.
    const DisparityImage disparity = matcher.match(left_texture, right_texture).download();
    const double gpu_ms =
        median_gpu_ms(options.repeats, [&] { matcher.match(left_texture, right_texture); });

    nlohmann::ordered_json result{
        {"width", matched.width},
        {"height", matched.height},
        {"disparities", options.disparities},
        {"matcher", matcher_name},
        {"preset", options.preset},
        {"gpu_ms", gpu_ms},
        {"renderer", gl.renderer},
        {"density",
         static_cast<double>(cv::countNonZero(disparity)) / static_cast<double>(matched.area())},
        {"median_disparity_px", median_px(disparity)},
        {"fill", settings.fill},
        {"output", options.output},
        {"px_per_code",
         disparity_form(options.output) == DisparityForm::pfm ? 1.0 : 1.0 / disparity_steps_per_px},
    };
    const GreyImage confidence =
        settings.confidence ? GreyImage(matcher.confidence()->download()) : GreyImage();
    if (settings.confidence) {
        result["confidence"] = options.confidence;
        result["mean_confidence"] = cv::mean(confidence)[0] / 255;
    }
    if (options.explain) {
        matcher.set_profiling(true);
        matcher.match(left_texture, right_texture);
        result["passes"] = passes_as_json(matcher);
        result["gpu_bytes"] = matcher.gpu_bytes();
        result["cost_volume_bytes"] = matcher.cost_volume_bytes();
        result["modelled_frame_ms"] = modelled_frames_as_json(matcher);
    }
    write_disparity(options.output, disparity);
    if (!options.colour_map.empty())
        write_colour_image(options.colour_map,
                           colour_map_disparity(to_float_px(disparity), 0,
                                                static_cast<float>(options.disparities)));
    if (settings.confidence) write_grey_image(options.confidence, confidence);
    print_result(result, options.json);
    if (options.explain && !options.json) std::cout << '\n' << pass_table(matcher);
}

std::string matcher_summaries() {
    std::string lines;
    for (const MatcherEntry& entry : matcher_entries())
        lines += fmt::format("\n  {}: {}", entry.name, entry.summary);
    return lines;
}

}  // namespace

CommandEntry match_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<MatchOptions>();
        CLI::App* command = program.add_subcommand(
            "match", "Match one rectified pair, by the same code as the rig daemon");
        command->footer("Unknown is +infinity in a .pfm and 0 in a .png.\nMatchers:" +
                        matcher_summaries());
        command->add_option("left", options->left, "Left picture")->required();
        command->add_option("right", options->right, "Right picture")->required();
        command
            ->add_option("--disparities", options->disparities,
                         fmt::format("Search disparities from 0 to N - 1 px; N is 1 to {}",
                                     MatchSettings::max_disparities))
            ->type_name("N")
            ->required();
        command
            ->add_option(
                "--width", options->width_px,
                "Reduce both pictures to this width before they are matched, as 'width_px' "
                "in [match] of rig.toml does; disparities count the smaller pixels")
            ->check(CLI::Range(1, MatchSettings::max_side_px))
            ->type_name("PX");
        command->add_option("--matcher", options->matcher,
                            "Select the matcher (default: the preset's); see below");
        command
            ->add_option("--preset", options->preset,
                         "Select the preset: fast, balanced or quality")
            ->capture_default_str();
        command
            ->add_option(
                "-o,--output", options->output,
                "Write the disparities to this file: .pfm (float, px) or .png (16-bit, 1/32 px)")
            ->required();
        command->add_option(
            "--colormap", options->colour_map,
            "Also write them as a picture in colours: blue is 0, red is N, black is unknown");
        command
            ->add_option("--confidence", options->confidence,
                         "Also write the confidence of each pixel as an 8-bit .png: 255 is the "
                         "highest, 0 is unknown or filled")
            ->type_name("FILE");
        command->add_flag("--no-fill", options->no_fill, "Do not fill unknown pixels");
        command
            ->add_option("--repeats", options->repeats,
                         "Match this many times; gpu_ms is the median")
            ->check(CLI::Range(1, 1000))
            ->capture_default_str();
        command->add_flag("--explain", options->explain,
                          "Also print time, traffic, operations and memory of every GPU pass");
        command->add_flag("--json", options->json, "Print the result as one JSON object");
        command->callback([options] { match(*options); });
    }};
}

}  // namespace vantage
