#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "common/base/command.h"
#include "common/base/error.h"
#include "common/base/print_result.h"
#include "common/gl/egl_context.h"
#include "common/gl/gpu_timer.h"
#include "common/gl/limits.h"
#include "common/image/image_file.h"
#include "host_app/fusion/image_metrics.h"
#include "host_app/fusion/novelty_overlay.h"
#include "host_app/fusion/synthesiser.h"
#include "host_app/fusion/view_set.h"

namespace vantage {
namespace {

constexpr int timed_renderings = 5;

struct RenderOptions {
    std::string views, hold_out, pose, synthesiser = default_synthesiser, output, difference;
    bool novelty = false, json = false;
};

void render(const RenderOptions& options) {
    ViewSet set = load_view_set(options.views);
    VirtualView target;
    ColourImage truth;
    if (!options.hold_out.empty()) {
        // Taken out of the set before anything sees the set.
        const auto held_out =
            set.views.begin() + static_cast<std::ptrdiff_t>(set.index_of(options.hold_out));
        truth = held_out->colour;
        target = {truth.cols, truth.rows, held_out->K, held_out->world_from_camera};
        set.views.erase(held_out);
    } else {
        target = load_virtual_view(options.pose);
    }
    if (std::none_of(set.views.begin(), set.views.end(),
                     [](const DepthView& view) { return !view.depth_m.empty(); }))
        fail(
            "{}: no view that is left has 'disparity' or 'depth'; give at least one of them "
            "geometry",
            options.views);

    const EglContext context;
    const GlInfo gl = GlInfo::query();
    gl.require_vantage_minimum();
    const ShaderLibrary shaders;
    const std::unique_ptr<Synthesiser> synthesiser = make_synthesiser(options.synthesiser, shaders);
    if (options.novelty) NoveltyOverlay::require(*synthesiser, options.synthesiser);
    synthesiser->set_views(set.views);
    const ColourImage picture = synthesiser->render(target).download();
    const double gpu_ms = median_gpu_ms(timed_renderings, [&] { synthesiser->render(target); });

    nlohmann::ordered_json result{
        {"width", target.width_px}, {"height", target.height_px}, {"synth", options.synthesiser}};
    if (!truth.empty()) {
        result["hold_out"] = options.hold_out;
        result["psnr_db"] = psnr_db(picture, truth);
        result["psnr_covered_db"] = psnr_db(picture, truth, covered_mask(picture));
        result["ssim"] = ssim(picture, truth);
    }
    result["coverage"] = coverage(picture);
    result["gpu_ms"] = gpu_ms;
    result["renderer"] = gl.renderer;
    ColourImage shown = picture;
    if (options.novelty) {
        NoveltyOverlay overlay(shaders);
        for (const DepthView& view : set.views)
            if (!view.depth_m.empty()) overlay.name_rigs({view.name});
        const Texture& plain = synthesiser->render(target);
        const PixelOrigins& origins = *synthesiser->origins();
        result["novelty"] = to_json(novelty_shares(picture, origins));
        for (const NoveltyOverlay::Key& key : overlay.legend())
            result["novelty"]["colours"][key.rig] =
                fmt::format("#{:02x}{:02x}{:02x}", key.colour[0], key.colour[1], key.colour[2]);
        shown = overlay.lay(plain, origins).download();
    }

    write_colour_image(options.output, shown);
    if (!options.difference.empty())
        write_colour_image(options.difference, difference_picture(picture, truth));
    print_result(result, options.json);
}

}  // namespace

CommandEntry render_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<RenderOptions>();
        CLI::App* command = program.add_subcommand("render", "One novel view from a view set");
        std::string synthesisers;
        for (const SynthesiserEntry& entry : synthesiser_entries())
            synthesisers += fmt::format("\n  {}: {}", entry.name, entry.summary);
        command->footer(
            "A pose file is JSON (or TOML, by its extension) with the keys of views.json:\n"
            "  {\"width\": 640, \"height\": 360,\n"
            "   \"K\": [[fx, skew, cx], [0, fy, cy], [0, 0, 1]],\n"
            "   \"world_from_camera\": [[r, r, r, x], [r, r, r, y], [r, r, r, z]]}\n"
            "Pixel centres are at integer coordinates; x right, y down, z forward; metres.\n"
            "Synthesisers:" +
            synthesisers);
        command->add_option("--views", options->views, "Folder with a views.json")->required();
        auto* target = command->add_option_group("camera", "which view to render");
        auto* hold_out = target->add_option(
            "--hold-out", options->hold_out,
            "Withhold this view, render it from the others and compare: psnr_db, ssim");
        target->add_option("--pose", options->pose, "Render the camera that this file describes");
        target->require_option(1);
        command->add_option("--synth", options->synthesiser, "Synthesiser")->capture_default_str();
        command->add_option("-o,--output", options->output, "Picture to write (.png or .jpg)")
            ->required();
        command
            ->add_option("--difference", options->difference,
                         "With --hold-out: also write 4 * |rendered - true|")
            ->needs(hold_out);
        command->add_flag("--novelty", options->novelty,
                          "Write which views the pixels come from, a colour a view, what none has "
                          "seen hatched; the numbers are still those of the plain picture");
        command->add_flag("--json", options->json, "Write the result as one JSON object");
        command->callback([options] { render(*options); });
    }};
}

}  // namespace vantage
