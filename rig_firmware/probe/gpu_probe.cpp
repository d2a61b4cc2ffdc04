#include <array>

#include "common/base/error.h"
#include "common/config/gpu_frame_model.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "rig_firmware/probe/probe.h"

namespace vantage {
namespace {

/// Extensions that turn a camera's buffer into a texture without a copy.
constexpr std::array<const char*, 2> import_by_egl = {"EGL_EXT_image_dma_buf_import",
                                                      "EGL_EXT_image_dma_buf_import_modifiers"};
constexpr std::array<const char*, 2> import_by_gl = {"GL_OES_EGL_image",
                                                     "GL_OES_EGL_image_external_essl3"};

void describe(ProbePart& part, const EglContext& context) {
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
    if (const GpuFrameModel* model = GpuFrameModel::of(info.renderer)) {
        constexpr double rate_hz = 30;
        constexpr MatchedFrame frames[] = {{640, 400, 64, rate_hz},
                                           {640, 480, 64, rate_hz, 960, 720},
                                           {960, 720, 64, rate_hz},
                                           {1280, 800, 128, rate_hz}};
        for (const MatchedFrame& frame : frames) {
            part.lines.push_back(model->fit_text(frame));
            part.facts["fits"].push_back(nlohmann::json(model->fit_json(frame)));
        }
    }
    try {
        info.require_vantage_minimum();
    } catch (const Error& error) {
        part.unfit.emplace_back(error.what());
    }
}

}  // namespace

ProbePart probe_gpu() {
    ProbePart part{
        .title = "GPU", .facts = {{"attempts", nlohmann::json::array()}}, .lines = {}, .unfit = {}};
    try {
        const EglContext context;
        describe(part, context);
    } catch (const Error& error) {
        part.unfit.emplace_back(error.what());
    }
    return part;
}

}  // namespace vantage
