#include "common/config/gpu_frame_model.h"

#include <fmt/format.h>

namespace vantage {
namespace {

/// From docs/results/v3d.md: the bounds at 640x400x64, of which the passes over the cost volume
/// grow with the disparities.
constexpr GpuFrameModel models[] = {
    {"Raspberry Pi 5",
     "V3D 7.1",
     {{"quality", 50.1, 2.190}, {"balanced", 35.2, 0.713}, {"fast", 28.6, 0.523}}},
    {"Raspberry Pi 4",
     "V3D 4.2",
     {{"quality", 113.5, 5.079}, {"balanced", 85.7, 1.854}, {"fast", 75.2, 1.231}}},
};

}  // namespace

std::span<const GpuFrameModel> GpuFrameModel::all() { return models; }

const GpuFrameModel* GpuFrameModel::of(std::string_view renderer) {
    for (const GpuFrameModel& model : models)
        if (renderer.starts_with(model.renderer)) return &model;
    return nullptr;
}

double GpuFrameModel::frame_ms(const Preset& preset, int width_px, int height_px, int disparities) {
    const double pixels = static_cast<double>(width_px) * height_px;
    return pixels * (preset.ns_per_pixel + preset.ns_per_pixel_disparity * disparities) * 1e-6;
}

const GpuFrameModel::Preset* GpuFrameModel::best_for(int width_px, int height_px, int disparities,
                                                     double rate_hz) const {
    const double limit_ms = 1e3 / rate_hz * 2 / 3;
    for (const Preset& preset : presets)
        if (frame_ms(preset, width_px, height_px, disparities) <= limit_ms) return &preset;
    return nullptr;
}

std::string GpuFrameModel::fit_text(int width_px, int height_px, int disparities,
                                    double rate_hz) const {
    std::string bounds;
    for (const Preset& preset : presets)
        bounds += fmt::format("{}{} {:.1f}", bounds.empty() ? "" : ", ", preset.name,
                              frame_ms(preset, width_px, height_px, disparities));
    const Preset* best = best_for(width_px, height_px, disparities, rate_hz);
    return fmt::format(
        "{}x{} with {} disparities at {:.4g} Hz on the {}: {} (lower bounds of a frame by the "
        "compiler's numbers, ms: {})",
        width_px, height_px, disparities, rate_hz, board,
        best ? fmt::format("'{}' may fit", best->name) : "no preset fits", bounds);
}

}  // namespace vantage
