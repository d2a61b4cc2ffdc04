#include "common/config/gpu_frame_model.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vantage {
namespace {

/// From docs/results/v3d.md: the bounds at 640x400x64, of which the passes over the cost volume
/// grow with the disparities. The reduction is that of 960x720 to 640x480.
constexpr GpuFrameModel models[] = {
    {"Raspberry Pi 5",
     "V3D 7.1",
     5.5,
     2.0,
     {{{"quality", 44.6, 2.190}, {"balanced", 29.7, 0.713}, {"fast", 23.0, 0.523}}}},
    {"Raspberry Pi 4",
     "V3D 4.2",
     16.6,
     3.2,
     {{{"quality", 96.9, 5.079}, {"balanced", 69.0, 1.854}, {"fast", 58.6, 1.176}}}},
};

}  // namespace

std::span<const GpuFrameModel> GpuFrameModel::all() { return models; }

const GpuFrameModel* GpuFrameModel::of(std::string_view renderer) {
    for (const GpuFrameModel& model : models)
        if (renderer.starts_with(model.renderer)) return &model;
    return nullptr;
}

double GpuFrameModel::frame_ms(const Preset& preset, const MatchedFrame& frame) const {
    const double matched = static_cast<double>(frame.width_px) * frame.height_px;
    const double colour = static_cast<double>(frame.colour_width_px) * frame.colour_height_px;
    double ns = matched * (preset.ns_per_pixel + preset.ns_per_pixel_disparity * frame.disparities);
    ns += std::max(matched, colour) * ns_per_rectified_pixel;
    if (colour > 0) ns += (matched + colour) * ns_per_reduced_pixel;
    return ns * 1e-6;
}

GpuFrameModel::Fit GpuFrameModel::fit(const MatchedFrame& frame) const {
    Fit fit{};
    for (std::size_t i = 0; i < presets.size(); ++i) {
        fit.bounds_ms[i] = frame_ms(presets[i], frame);
        if (!fit.best && fit.bounds_ms[i] <= limit_ms(frame.rate_hz)) fit.best = &presets[i];
    }
    return fit;
}

std::string GpuFrameModel::fit_text(const MatchedFrame& frame) const {
    const Fit found = fit(frame);
    std::string bounds;
    for (std::size_t i = 0; i < presets.size(); ++i)
        bounds +=
            fmt::format("{}{} {:.1f}", i == 0 ? "" : ", ", presets[i].name, found.bounds_ms[i]);
    const std::string reduced =
        frame.colour_width_px > 0
            ? fmt::format(", reduced from {}x{}", frame.colour_width_px, frame.colour_height_px)
            : "";
    return fmt::format(
        "{}x{}{} with {} disparities at {:.4g} Hz on the {}: {} (lower bounds of a frame by the "
        "compiler's numbers, ms: {})",
        frame.width_px, frame.height_px, reduced, frame.disparities, frame.rate_hz, board,
        found.best ? fmt::format("'{}' may fit", found.best->name) : "no preset fits", bounds);
}

nlohmann::ordered_json GpuFrameModel::fit_json(const MatchedFrame& frame) const {
    const Fit found = fit(frame);
    nlohmann::ordered_json bounds;
    for (std::size_t i = 0; i < presets.size(); ++i) bounds[presets[i].name] = found.bounds_ms[i];
    nlohmann::ordered_json json{{"board", board},
                                {"width_px", frame.width_px},
                                {"height_px", frame.height_px},
                                {"disparities", frame.disparities},
                                {"rate_hz", frame.rate_hz}};
    if (frame.colour_width_px > 0) {
        json["colour_width_px"] = frame.colour_width_px;
        json["colour_height_px"] = frame.colour_height_px;
    }
    json["preset"] = found.best ? nlohmann::ordered_json(found.best->name) : nullptr;
    json["lower_bounds_ms"] = std::move(bounds);
    return json;
}

}  // namespace vantage
