#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace vantage {

/// The pictures of a rig's frame, for GpuFrameModel.
struct MatchedFrame {
    int width_px, height_px;  ///< of the pictures that are matched
    int disparities;
    double rate_hz;
    /// Of the rectified pictures, if they are reduced before they are matched; 0: no reduction.
    int colour_width_px = 0, colour_height_px = 0;
};

/// Lower bounds of the time that a Raspberry Pi's GPU takes for a rig's frame, from the
/// instructions that its compiler emits and the bytes that the passes move (docs/results/v3d.md,
/// tools/v3d.sh).
struct GpuFrameModel {
    /// Time of a preset without rectification: a part for each matched pixel, and one for each of
    /// them and disparity.
    struct Preset {
        const char* name;
        double ns_per_pixel, ns_per_pixel_disparity;
    };
    static constexpr std::size_t preset_count = 3;

    /// The lower bounds of a frame, and the preset that follows from them.
    struct Fit {
        std::array<double, preset_count> bounds_ms;  ///< of each preset
        /// The best preset whose lower bound is within limit_ms(); null: none.
        const Preset* best;
    };

    const char* board;
    std::string_view renderer;      ///< how OpenGL ES names the GPU, from its beginning
    double ns_per_rectified_pixel;  ///< of both pictures
    double ns_per_reduced_pixel;    ///< the same for each pixel that is reduced or results from it
    std::array<Preset, preset_count> presets;  ///< the best one first

    /// The time that a frame may take so that a rig holds its rate with a margin of a third, ms.
    static constexpr double limit_ms(double rate_hz) { return 1e3 / rate_hz * 2 / 3; }

    static std::span<const GpuFrameModel> all();
    /// Null where no model is known for this GPU.
    static const GpuFrameModel* of(std::string_view renderer);

    double frame_ms(const Preset& preset, const MatchedFrame& frame) const;
    Fit fit(const MatchedFrame& frame) const;
    /// A sentence for people about fit().
    std::string fit_text(const MatchedFrame& frame) const;
    /// The same for machines.
    nlohmann::ordered_json fit_json(const MatchedFrame& frame) const;
};

}  // namespace vantage
