#include <array>

#include "common/base/error.h"
#include "common/config/gpu_frame_model.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/gpu_timer.h"
#include "common/gl/objects/texture.h"
#include "common/gl/shader_library.h"
#include "common/image/image.h"
#include "rig_firmware/probe/probe.h"
#include "rig_firmware/stereo/matcher.h"

namespace vantage {
namespace {

/// Extensions that turn a camera's buffer into a texture without a copy.
constexpr std::array<const char*, 2> import_by_egl = {"EGL_EXT_image_dma_buf_import",
                                                      "EGL_EXT_image_dma_buf_import_modifiers"};
constexpr std::array<const char*, 2> import_by_gl = {"GL_OES_EGL_image",
                                                     "GL_OES_EGL_image_external_essl3"};

/// The rate at which the presets are judged.
constexpr double rate_hz = 30;

/// Adds the times of the presets by the model of this GPU.
void add_modelled_fits(ProbePart& part, const GpuFrameModel& model) {
    constexpr MatchedFrame frames[] = {{640, 400, 64, rate_hz},
                                       {640, 480, 64, rate_hz, 960, 720},
                                       {960, 720, 64, rate_hz},
                                       {1280, 800, 128, rate_hz}};
    for (const MatchedFrame& frame : frames) {
        part.lines.push_back(model.fit_text(frame));
        part.facts["fits"].push_back(nlohmann::json(model.fit_json(frame)));
    }
}

/// Adds the times of the presets on a GPU without a model: each matches a dark pair a few times.
/// Compiling their shaders takes some seconds the first time.
void add_measured_fits(ProbePart& part) {
    constexpr int width_px = 640, height_px = 400, disparities = 64, repeats = 3;
    const ShaderLibrary shaders;
    Texture dark(TextureFormat::rgba8, width_px, height_px);
    dark.upload(ColourImage(height_px, width_px, cv::Vec4b(0, 0, 0, 255)));
    nlohmann::json times;
    std::string text, best;
    double last_ms = 0;
    for (const char* name : preset_names) {
        const MatchSettings settings{.width_px = width_px,
                                     .height_px = height_px,
                                     .disparities = disparities,
                                     .preset = parse_preset(name)};
        const std::unique_ptr<Matcher> matcher =
            make_matcher(default_matcher(settings.preset), shaders, settings);
        matcher->match(dark, dark);  // drivers finish compiling at the first draw call
        last_ms = median_gpu_ms(repeats, [&] { matcher->match(dark, dark); });
        times[name] = last_ms;
        text += fmt::format("{}{} {:.1f}", text.empty() ? "" : ", ", name, last_ms);
        if (best.empty() && last_ms <= GpuFrameModel::limit_ms(rate_hz)) best = name;
    }
    part.facts["fits"].push_back(
        {{"width_px", width_px},
         {"height_px", height_px},
         {"disparities", disparities},
         {"rate_hz", rate_hz},
         {"preset", best.empty() ? nlohmann::json() : nlohmann::json(best)},
         {"measured_ms", std::move(times)}});
    part.lines.push_back(fmt::format(
        "{}x{} with {} disparities at {:.4g} Hz on this GPU: {} (measured without rectification, "
        "ms: {})",
        width_px, height_px, disparities, rate_hz,
        best.empty()
            ? fmt::format("no preset fits, and 'fast' holds {:.1f} Hz", 1e3 * 2 / 3 / last_ms)
            : fmt::format("'{}' fits", best),
        text));
}

void describe(ProbePart& part, const EglContext& context, bool measures) {
    for (const EglAttempt& attempt : context.attempts()) {
        part.facts["attempts"].push_back(
            {{"platform", attempt.platform}, {"outcome", attempt.outcome}});
        part.lines.push_back(fmt::format("EGL {}: {}", attempt.platform, attempt.outcome));
    }
    const GlInfo info = GlInfo::query();
    part.facts["vendor"] = info.vendor;
    part.facts["renderer"] = info.renderer;
    part.facts["version"] = info.version;
    part.facts["is_software"] = info.is_software;
    part.facts["limits"] = {{"texture_side_px", info.max_texture_side_px},
                            {"colour_targets", info.max_colour_targets},
                            {"workgroup_invocations", info.max_workgroup_invocations},
                            {"shared_bytes", info.max_shared_bytes},
                            {"timer_queries", info.has_timer_queries}};
    part.lines.push_back(fmt::format("{} ({}), {}", info.renderer, info.vendor, info.version));
    part.lines.push_back(fmt::format(
        "textures to {} px, {} colour targets, {} invocations a workgroup, {} bytes shared, timer "
        "queries: {}",
        info.max_texture_side_px, info.max_colour_targets, info.max_workgroup_invocations,
        info.max_shared_bytes, info.has_timer_queries ? "yes" : "no"));
    bool can_import = true;
    const auto note = [&](const char* extension, bool is_there) {
        part.facts["import"][extension] = is_there;
        part.lines.push_back(fmt::format("{}: {}", extension, is_there ? "yes" : "no"));
        can_import = can_import && is_there;
    };
    for (const char* extension : import_by_egl) note(extension, context.has_extension(extension));
    for (const char* extension : import_by_gl) note(extension, has_gl_extension(extension));
    if (info.is_software)
        part.unfit.push_back(fmt::format(
            "OpenGL ES is drawn by the processor ({}): fit for trying out, too slow for a rig at "
            "its "
            "full rate and size; give this user access to /dev/dri/renderD*, or install the GPU's "
            "driver",
            info.renderer));
    if (!can_import)
        part.unfit.emplace_back(
            "the driver cannot import camera buffers (dma-buf): every picture is copied to the "
            "GPU");
    try {
        info.require_vantage_minimum();
        if (const GpuFrameModel* model = GpuFrameModel::of(info.renderer))
            add_modelled_fits(part, *model);
        else if (measures)
            add_measured_fits(part);
    } catch (const Error& error) {
        part.unfit.emplace_back(error.what());
    }
}

}  // namespace

ProbePart probe_gpu(bool measures) {
    ProbePart part{
        .title = "GPU", .facts = {{"attempts", nlohmann::json::array()}}, .lines = {}, .unfit = {}};
    try {
        const EglContext context;
        describe(part, context, measures);
    } catch (const Error& error) {
        part.unfit.emplace_back(error.what());
    }
    return part;
}

}  // namespace vantage
