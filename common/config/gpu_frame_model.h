#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Lower bounds of the time that a Raspberry Pi's GPU takes for a rig's frame, from the
/// instructions that its compiler emits and the bytes that the passes move (docs/results/v3d.md,
/// tools/v3d.sh).
struct GpuFrameModel {
    /// Time of a preset: a part for each pixel, and one for each pixel and disparity.
    struct Preset {
        const char* name;
        double ns_per_pixel, ns_per_pixel_disparity;
    };

    const char* board;
    std::string_view renderer;  ///< how OpenGL ES names the GPU, from its beginning
    Preset presets[3];          ///< the best one first

    static std::span<const GpuFrameModel> all();
    /// Null where no model is known for this GPU.
    static const GpuFrameModel* of(std::string_view renderer);

    static double frame_ms(const Preset& preset, int width_px, int height_px, int disparities);
    /// The best preset whose lower bound is within two thirds of a period; null: none.
    const Preset* best_for(int width_px, int height_px, int disparities, double rate_hz) const;
    /// A sentence for people about a size and a rate, with the bound of each preset.
    std::string fit_text(int width_px, int height_px, int disparities, double rate_hz) const;
};

}  // namespace vantage
