#pragma once

#include <string>

#include <GLES3/gl31.h>

namespace vantage {

/// The limits that Vantage's shaders are written for: those of a Raspberry Pi 4 (V3D 4.2, Mesa).
/// Program and Framebuffer enforce them on every computer, so that shaders that run here also run
/// on a Pi.
struct PiLimits {
    static constexpr int max_workgroup_invocations = 256;
    static constexpr int max_colour_targets = 4;
    static constexpr int max_image_side_px = 4096;
    static constexpr int max_shared_bytes = 16 * 1024;
};

/// The capabilities of the current context.
struct GlInfo {
    std::string vendor, renderer, version;
    int max_texture_side_px = 0;
    int max_colour_targets = 0;
    int max_workgroup_invocations = 0;
    int max_shared_bytes = 0;
    bool has_timer_queries = false;
    bool is_software = false;  ///< llvmpipe or softpipe

    static GlInfo query();
    /// Whether threads have to take turns at calling the driver (DriverLock): true for software
    /// renderers of Mesa before 25, or of an unknown version.
    bool needs_turns() const;
    /// Throws Error naming the first capability below PiLimits.
    void require_vantage_minimum() const;
};

bool has_gl_extension(const char* name);

/// Throws Error with `doing` if GL has an error flag (a fault of the driver or of memory at this
/// point), ContextLost if the GPU was reset.
void check_gl(const char* doing);

}  // namespace vantage
