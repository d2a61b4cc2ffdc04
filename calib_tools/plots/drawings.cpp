#include "calib_tools/plots/drawings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calib_tools/plots/html_page.h"

namespace vantage {
namespace {

constexpr double drawing_px = 420;
constexpr const char* ink = "#27598f";

std::string svg(double width, double height, const std::string& content) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
        "viewBox=\"0 "
        "0 {0:.0f} {1:.0f}\">{2}</svg>",
        width, height, content);
}

std::string line(double x0, double y0, double x1, double y1, const char* colour, double width = 1,
                 const char* dashes = "none") {
    return fmt::format(
        "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"{}\" "
        "stroke-width=\"{}\" stroke-dasharray=\"{}\"/>",
        x0, y0, x1, y1, colour, width, dashes);
}

std::string words(double x, double y, const std::string& text, const char* anchor = "start",
                  const char* colour = "#586475") {
    return fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\" stroke=\"none\">{}</text>",
        x, y, anchor, colour, escape_markup(text));
}

/// Largest number of the form 1, 2 or 5 times a power of ten that is at most `value`.
double round_down(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    return value >= 5 * power ? 5 * power : value >= 2 * power ? 2 * power : power;
}

}  // namespace

std::string draw_vectors(int width_px, int height_px, const std::vector<PictureVector>& vectors) {
    const double scale = drawing_px / width_px, height = height_px * scale;
    std::vector<double> sizes;
    for (const PictureVector& v : vectors) sizes.push_back(v.miss_px.norm());
    double factor = 1;
    if (!sizes.empty()) {
        const auto large = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 9 / 10);
        std::nth_element(sizes.begin(), large, sizes.end());
        factor = round_down(std::max(1.0, 14 / std::max(1e-4, *large * scale)));
    }
    std::string content;
    for (const PictureVector& v : vectors) {
        const Eigen::Vector2d from = scale * v.at_px, to = from + scale * factor * v.miss_px;
        content += line(from.x(), from.y(), to.x(), to.y(), ink, 0.8);
        content += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1\" fill=\"{}\"/>",
                               from.x(), from.y(), ink);
    }
    content +=
        words(6, height - 6, fmt::format("{} places, enlarged {:g} times", vectors.size(), factor));
    return svg(drawing_px, height, content);
}

std::string draw_coverage(int width_px, int height_px, int columns, int rows,
                          const std::vector<int>& counts) {
    const double width = drawing_px, height = drawing_px * height_px / width_px;
    const double cell_w = width / columns, cell_h = height / rows;
    const int most =
        counts.empty() ? 1 : std::max(1, *std::max_element(counts.begin(), counts.end()));
    std::string content;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const int count = counts[static_cast<std::size_t>(r * columns + c)];
            const double share = std::sqrt(count / static_cast<double>(most));
            content += fmt::format(
                "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" "
                "fill-opacity=\"{:.2f}\" stroke=\"#d5dbe3\"/>",
                c * cell_w, r * cell_h, cell_w, cell_h, count > 0 ? ink : "#c0202b",
                count > 0 ? 0.15 + 0.75 * share : 0.18);
            content += words((c + 0.5) * cell_w, (r + 0.5) * cell_h + 4, std::to_string(count),
                             "middle", share > 0.6 ? "#fff" : "#27303c");
        }
    return svg(width, height, content);
}

std::string draw_bars(const std::vector<Bar>& bars, const std::string& unit, double usual) {
    constexpr double height = 220, left = 44, bottom = 70, top = 12;
    const double step =
        bars.empty() ? 1 : std::clamp(860.0 / static_cast<double>(bars.size()), 6.0, 28.0);
    double most = std::max(1e-9, 1.2 * usual);
    for (const Bar& bar : bars) most = std::max(most, bar.value);
    const double scale = (height - bottom - top) / most;
    const double width = left + step * static_cast<double>(bars.size()) + 16;
    std::string content;
    const double tick = round_down(most / 2);
    for (double value = 0; value <= most; value += tick) {
        const double y = height - bottom - scale * value;
        content += line(left, y, width, y, "#e4e8ee");
        content += words(left - 4, y + 4, fmt::format("{:g}", value), "end");
    }
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const double x = left + step * static_cast<double>(i), bar = scale * bars[i].value;
        content += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
            "fill=\"{}\"><title>{}: "
            "{:.3f} {}</title></rect>",
            x + 0.1 * step, height - bottom - bar, 0.8 * step, bar,
            usual > 0 && bars[i].value > 2 * usual ? "#a86300" : ink, escape_markup(bars[i].name),
            bars[i].value, escape_markup(unit));
        if (step >= 12)
            content += fmt::format(
                "<text transform=\"translate({:.1f},{:.1f}) rotate(60)\" font-size=\"9\" "
                "fill=\"#586475\">{}</text>",
                x + 0.35 * step, height - bottom + 9, escape_markup(bars[i].name.substr(0, 14)));
    }
    if (usual > 0) {
        const double y = height - bottom - scale * usual;
        content += line(left, y, width, y, "#586475", 1, "4 3");
    }
    content += words(4, top, unit);
    return svg(width, height, content);
}

std::string draw_stage(const std::vector<PlacedRig>& rigs, const std::vector<RigTie>& ties,
                       bool y_is_up) {
    // Without a floor the world is a camera's own frame, whose y points down; the view from above
    // is the same plane.
    const auto flat = [](const Eigen::Vector3d& p) { return Eigen::Vector2d(p.x(), p.z()); };
    // A world with a floor is centred on its origin; a camera's world begins there.
    Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = low;
    double reach_m = 1;
    for (const PlacedRig& rig : rigs) {
        const Eigen::Vector2d at = flat(rig.world_from_camera.translation());
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
    }
    reach_m = std::max(0.5, 0.35 * (high - low).maxCoeff());
    low.array() -= 0.3 * reach_m + 0.3;
    high.array() += 0.3 * reach_m + 0.3;
    const double scale = drawing_px * 1.3 / std::max(high.x() - low.x(), high.y() - low.y());
    // The audience is at the bottom of the page: +z with a floor, -z in a camera's world.
    const auto page = [&](const Eigen::Vector2d& p) {
        return Eigen::Vector2d((p.x() - low.x()) * scale,
                               (y_is_up ? p.y() - low.y() : high.y() - p.y()) * scale);
    };
    std::string content;
    const double grid_m = round_down(0.25 * (high - low).maxCoeff());
    for (double x = std::ceil(low.x() / grid_m) * grid_m; x <= high.x(); x += grid_m) {
        const Eigen::Vector2d a = page({x, low.y()}), b = page({x, high.y()});
        content += line(a.x(), a.y(), b.x(), b.y(), "#e4e8ee");
    }
    for (double z = std::ceil(low.y() / grid_m) * grid_m; z <= high.y(); z += grid_m) {
        const Eigen::Vector2d a = page({low.x(), z}), b = page({high.x(), z});
        content += line(a.x(), a.y(), b.x(), b.y(), "#e4e8ee");
    }
    const Eigen::Vector2d origin = page({0, 0});
    content += line(origin.x() - 5, origin.y(), origin.x() + 5, origin.y(), "#586475");
    content += line(origin.x(), origin.y() - 5, origin.x(), origin.y() + 5, "#586475");
    for (const RigTie& tie : ties) {
        const Eigen::Vector2d a = page(flat(rigs[tie.a].world_from_camera.translation()));
        const Eigen::Vector2d b = page(flat(rigs[tie.b].world_from_camera.translation()));
        content += line(a.x(), a.y(), b.x(), b.y(), tie.weak ? "#c0202b" : "#137a3b",
                        tie.weak ? 1 : 1.6, tie.weak ? "3 3" : "none");
        content += words(0.5 * (a.x() + b.x()), 0.5 * (a.y() + b.y()) - 3, tie.label, "middle");
    }
    for (const PlacedRig& rig : rigs) {
        const Eigen::Vector3d at_m = rig.world_from_camera.translation();
        const Eigen::Vector2d at = page(flat(at_m));
        for (const double side : {-0.5, 0.5}) {
            const double angle = side * rig.field_of_view_rad;
            const Eigen::Vector3d edge = rig.world_from_camera.linear() *
                                         Eigen::Vector3d(std::sin(angle), 0, std::cos(angle));
            const Eigen::Vector2d to = page(flat(at_m + reach_m * edge));
            content += line(at.x(), at.y(), to.x(), to.y(), ink, 1, "5 3");
        }
        if (rig.sigma_m > 0)
            content += fmt::format(
                "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\" "
                "fill-opacity=\"0.15\"/>",
                at.x(), at.y(), 100 * rig.sigma_m * scale, ink);
        content += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>", at.x(),
                               at.y(), ink);
        content += words(at.x() + 7, at.y() - 7, rig.name, "start", "#1c2430");
    }
    const Eigen::Vector2d size = (high - low) * scale;
    content += words(6, size.y() - 6, fmt::format("grid {:g} m", grid_m));
    return svg(size.x(), size.y(), content);
}

std::string draw_history(const std::vector<double>& values, double warn_at, double bad_at,
                         const std::string& unit) {
    constexpr double width = 260, height = 70, pad = 6;
    double most = std::max(1.1 * warn_at, 1e-9);
    for (const double v : values) most = std::max(most, v);
    const auto y = [&](double v) { return height - pad - (height - 2 * pad) * v / most; };
    std::string content = line(0, y(warn_at), width, y(warn_at), "#a86300", 1, "3 3");
    if (bad_at <= most) content += line(0, y(bad_at), width, y(bad_at), "#c0202b", 1, "3 3");
    const double step =
        (width - 2 * pad) / std::max<double>(1, static_cast<double>(values.size()) - 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double x = pad + step * static_cast<double>(i);
        if (i > 0) content += line(x - step, y(values[i - 1]), x, y(values[i]), ink, 1.4);
        content += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\" fill=\"{}\"><title>{:.3f} "
            "{}</title></circle>",
            x, y(values[i]), ink, values[i], escape_markup(unit));
    }
    return svg(width, height, content);
}

}  // namespace vantage
