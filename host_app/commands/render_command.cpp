#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/print_result.h"
#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/gpu_timer.h"
#include "common/image/image_file.h"
#include "host_app/session/options/common_options.h"
#include "host_app/synthesis/source_map.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "host_app/view_sets/outline_depth.h"
#include "host_app/view_sets/view_set.h"

namespace vantage {
namespace {

/// Renderings whose median GPU time is reported.
constexpr int timed_renderings = 5;

struct RenderOptions {
    std::string views, hold_out, pose, synthesiser = default_synthesiser, output, difference;
    std::vector<std::string> earlier;
    bool source_map = false, json = false;
    StereoscopicOptions stereoscopic;
};

/// Renders a view set for one camera or for the eyes of a 3-D display, plain or as a source map.
class Rendering {
  public:
    Rendering(const RenderOptions& options, const std::string& synthesiser,
              const std::vector<ViewSet>& earlier, const ViewSet& set, const VirtualView& target,
              const ShaderLibrary& shaders)
        : synthesiser_(make_synthesiser(synthesiser, shaders)),
          overlay_(shaders),
          mosaic_(shaders) {
        eyes_ = {target};
        if (const auto asked = options.stereoscopic.stereoscopy()) {
            settled_ = asked->settled(target, typical_depth_m(set.views, target));
            eyes_ = eye_views(target, *settled_);
            mosaic_.begin({target.width_px, target.height_px}, *settled_);
        }
        if (options.source_map) {
            SourceMapOverlay::require(synthesiser_->note_origins(true), options.synthesiser);
            synthesiser_->note_origins(false);
            for (const DepthView& view : set.views)
                if (!view.depth_m.empty()) overlay_.name_rigs({view.name});
        }
        for (const ViewSet& instant : earlier) {
            synthesiser_->set_views(instant.views);
            synthesiser_->render_earlier(target);
        }
        synthesiser_->set_views(set.views);
    }

    const std::optional<Stereoscopy>& stereoscopy() const { return settled_; }

    const Texture& plain() {
        return all([](const Texture& eye) -> const Texture& { return eye; });
    }

    /// Renders the source map and stores its shares and colours in `result`.
    const Texture& source_map(nlohmann::ordered_json& result) {
        SourceShares sum;
        synthesiser_->note_origins(true);
        const Texture& picture = all([&](const Texture& eye) -> const Texture& {
            const PixelOrigins& origins = *synthesiser_->origins();
            const SourceShares shares = source_shares(eye.download(), origins);
            const auto eyes = static_cast<double>(eyes_.size());
            for (const auto& [rig, share] : shares.rigs) sum.rigs[rig] += share / eyes;
            sum.filled += shares.filled / eyes;
            sum.remembered += shares.remembered / eyes;
            return overlay_.lay(eye, origins);
        });
        synthesiser_->note_origins(false);
        result = to_json(sum);
        for (const SourceMapOverlay::Key& key : overlay_.legend())
            result["colours"][key.rig] =
                fmt::format("#{:02x}{:02x}{:02x}", key.colour[0], key.colour[1], key.colour[2]);
        return picture;
    }

  private:
    template <class Finish>
    const Texture& all(const Finish& finish) {
        if (!settled_) return finish(synthesiser_->render(eyes_.front()));
        for (std::size_t i = 0; i < eyes_.size(); ++i)
            mosaic_.put(finish(synthesiser_->render(eyes_[i])), i);
        return mosaic_.picture();
    }

    std::unique_ptr<Synthesiser> synthesiser_;
    SourceMapOverlay overlay_;
    std::optional<Stereoscopy> settled_;
    std::vector<VirtualView> eyes_;
    EyeMosaic mosaic_;
};

/// The folder of a view set, or a stage file with single cameras.
ViewSet load_views(const std::string& path) {
    return std::filesystem::path(path).extension() == ".toml" ? load_stage_views(path)
                                                              : load_view_set(path);
}

bool has_depth(const ViewSet& set) {
    return std::any_of(set.views.begin(), set.views.end(),
                       [](const DepthView& view) { return !view.depth_m.empty(); });
}

/// Gives views without any depth that of the hull of their outlines. Returns whether it did.
bool fall_back_to_outlines(const RenderOptions& options, ViewSet& set) {
    if (!find_synthesiser(options.synthesiser).needs_depth || has_depth(set)) return false;
    const auto outlines = std::count_if(set.outlines.begin(), set.outlines.end(),
                                        [](const GreyImage& outline) { return !outline.empty(); });
    if (outlines < 2)
        fail(
            "{}: none of the {} has 'disparity' or 'depth'. Add geometry to at least one view, or "
            "'outline' pictures, white where the performers are, to at least two, of which a hull "
            "is made ({} now). Views of a row of cameras can also be resampled without geometry: "
            "--synth lightfield",
            options.views, counted(set.views.size(), "remaining view"),
            outlines == 0 ? "none has one" : "one has one");
    set_depth_from_outlines(set.views, set.outlines);
    log_info("no view has depth: the hull of {} outlines is rendered", outlines);
    return true;
}

void render(const RenderOptions& options) {
    ViewSet set = load_views(options.views);
    std::vector<ViewSet> earlier;
    for (const std::string& folder : options.earlier) earlier.push_back(load_views(folder));
    VirtualView target;
    ColourImage truth;
    if (!options.hold_out.empty()) {
        // The view is removed before any other code sees the view set.
        const auto held_out =
            set.views.begin() + static_cast<std::ptrdiff_t>(set.index_of(options.hold_out));
        truth = held_out->colour;
        target = {truth.cols, truth.rows, held_out->K, held_out->world_from_camera};
        set.outlines.erase(set.outlines.begin() + (held_out - set.views.begin()));
        set.views.erase(held_out);
        for (ViewSet& instant : earlier)
            std::erase_if(instant.views,
                          [&](const DepthView& view) { return view.name == options.hold_out; });
    } else {
        target = load_virtual_view(options.pose);
    }
    const bool is_hull = fall_back_to_outlines(options, set);
    std::string synthesiser = options.synthesiser;
    if (is_hull && (synthesiser == "hull" || synthesiser == default_synthesiser)) {
        // A hull bulges where no camera looks, so that surfaces of different views disagree there,
        // and one that is computed for the target has neither gaps nor doubles.
        if (earlier.empty()) set.views = {hull_view(set.views, set.outlines, target)};
        synthesiser = default_synthesiser;
    }

    const EglContext context;
    const GlInfo gl = GlInfo::query();
    gl.require_vantage_minimum();
    const ShaderLibrary shaders;
    Rendering rendering(options, synthesiser, earlier, set, target, shaders);
    const ColourImage picture = rendering.plain().download();
    const double gpu_ms = median_gpu_ms(timed_renderings, [&] { rendering.plain(); });

    nlohmann::ordered_json result{{"width", target.width_px},
                                  {"height", target.height_px},
                                  {"synth", is_hull ? "hull" : options.synthesiser}};
    if (!truth.empty()) {
        result["hold_out"] = options.hold_out;
        result["psnr_db"] = psnr_db(picture, truth);
        result["psnr_covered_db"] = psnr_db(picture, truth, covered_mask(picture));
        result["ssim"] = ssim(picture, truth);
        const ImmersiveMetrics immersive = immersive_metrics(picture, truth);
        result["iv_psnr_db"] = immersive.iv_psnr_db;
        result["iv_ssim"] = immersive.iv_ssim;
    }
    result["coverage"] = coverage(picture);
    result["remembered"] = remembered(picture);
    result["gpu_ms"] = gpu_ms;
    result["renderer"] = gl.renderer;
    if (const auto& eyes = rendering.stereoscopy()) result["stereoscopic"] = to_json(*eyes);
    ColourImage shown = picture;
    if (options.source_map) {
        nlohmann::ordered_json shares;
        shown = rendering.source_map(shares).download();
        result["source_map"] = shares;
        result["novelty"] = shares;  // old name
    }

    write_with_alpha(options.output, shown, covered_mask(picture));
    if (!options.difference.empty())
        write_colour_image(options.difference, difference_picture(picture, truth));
    print_result(result, options.json);
}

}  // namespace

CommandEntry render_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<RenderOptions>();
        CLI::App* command = program.add_subcommand("render", "Render a view set from a new camera");
        command->footer(
            "A pose file is JSON, or TOML by its extension, with the keys of views.json:\n"
            "  {\"width\": 640, \"height\": 360,\n"
            "   \"K\": [[fx, skew, cx], [0, fy, cy], [0, 0, 1]],\n"
            "   \"world_from_camera\": [[r, r, r, x], [r, r, r, y], [r, r, r, z]]}\n"
            "Pixel centres are at integer coordinates; x right, y down, z forward; metres.\n" +
            synthesisers_help());
        command
            ->add_option("--views", options->views,
                         "Read the view set in this folder, or the single cameras of this "
                         "stage file (.toml)")
            ->required();
        command->add_option("--earlier", options->earlier,
                            "Read earlier view sets of the same rigs from these folders, oldest "
                            "first, to fill hidden background");
        auto* target = command->add_option_group("Camera", "The view to render");
        auto* hold_out = target->add_option(
            "--hold-out", options->hold_out,
            "Remove this view, render it from the others and compare: psnr_db, ssim, "
            "iv_psnr_db, iv_ssim");
        target->add_option("--pose", options->pose, "Render the camera of this pose file");
        target->require_option(1);
        options->stereoscopic
            .add_to(*command, "the median depth in view", option_group::stereoscopic)
            ->excludes(hold_out);
        command->add_option("--synth", options->synthesiser, "Select the synthesiser; see below")
            ->type_name(synthesisers_type_name())
            ->capture_default_str();
        command->add_option("-o,--output", options->output, "Write the picture (.png or .jpg)")
            ->required();
        command
            ->add_option("--difference", options->difference,
                         "With --hold-out: also write 4 * |rendered - true| to this file")
            ->needs(hold_out);
        CLI::Option* source_map =
            command->add_flag("--source-map", options->source_map,
                              "Write which view each pixel comes from, one colour per view, "
                              "inpainted pixels hatched; the results stay those of the plain "
                              "picture");
        accept_old_name(*command, source_map, "--novelty");  // old name
        command->add_flag("--json", options->json, "Print the result as one JSON object");
        command->callback([options] { render(*options); });
    }};
}

}  // namespace vantage
