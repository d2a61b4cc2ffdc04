// What the gallery's systems are worth beside `fused` on the same moments: writes the tables of
// docs/results/gallery.md and docs/develop/gallery.md between their markers, the contact sheet of
// one moment, docs/pictures/gallery.jpg, and a strip of each system,
// docs/pictures/gallery/NAME.jpg.
#include <algorithm>
#include <iostream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/gpu_timer.h"
#include "common/image/image_file.h"
#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "host_app/view_sets/view_set.h"
#include "tests/bench/support/markdown_tables.h"
#include "tests/bench/support/picture_sheet.h"
#include "tests/bench/support/run_bench.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr auto moment = 10s;
/// Instants before it, from which backgrounds are learnt.
constexpr auto between_instants = 500ms;
constexpr int instants_before = 16;
const cv::Size picture_size(320, 240);
constexpr int edge_band_px = 5;
constexpr int repeats = 3, sheet_columns = 3, strip_columns = 4;

/// The product's own, then the gallery's, with what can be chosen of them.
std::vector<std::string> systems() {
    std::vector<std::string> names{default_synthesiser};
    for (const SynthesiserEntry& entry : gallery_entries()) {
        names.push_back(entry.name);
        if (entry.name == "relief") names.push_back("relief:form=search");
        if (entry.name == "lightfield") names.push_back("lightfield:rays=corrected");
    }
    return names;
}

DepthView film(VirtualStage& stage, const StageCamera& camera, const std::string& name,
               std::chrono::nanoseconds time) {
    StageRendering seen = stage.render(camera, time);
    return {.name = name,
            .colour = seen.colour,
            .K = camera.K,
            .world_from_camera = camera.world_from_camera,
            .depth_m = seen.depth_m,
            .baseline_m = VirtualRigPlacement{}.baseline_m};
}

StageCamera rig_camera(double azimuth_deg) {
    const StereoCalibration rig =
        ideal_virtual_rig({.azimuth_rad = azimuth_deg * std::numbers::pi / 180,
                           .width_px = picture_size.width,
                           .height_px = picture_size.height});
    return {picture_size.width, picture_size.height, rig.left.K(), rig.world_from_left};
}

/// A view that nobody filmed, from views that somebody did.
struct Case {
    std::string name;
    std::vector<std::vector<DepthView>> before;  ///< instants, the oldest first
    std::vector<DepthView> views;
    DepthView truth;
};

Case on_stage(VirtualStage& stage, double apart_deg) {
    Case one;
    one.name = fmt::format("stage, {:g} degrees", apart_deg);
    const double azimuths_deg[] = {-1.5 * apart_deg, -0.5 * apart_deg, 0.5 * apart_deg,
                                   1.5 * apart_deg};
    for (int i = instants_before; i >= 0; --i) {
        std::vector<DepthView> views;
        for (const double azimuth_deg : azimuths_deg)
            views.push_back(film(stage, rig_camera(azimuth_deg), fmt::format("{:g}", azimuth_deg),
                                 moment - i * between_instants));
        if (i > 0)
            one.before.push_back(std::move(views));
        else
            one.views = std::move(views);
    }
    one.truth = film(stage, rig_camera(0), "truth", moment);
    return one;
}

/// Cameras beside each other, around the place of the view that is looked for but never there.
std::vector<DepthView> film_grid(VirtualStage& stage, cv::Size cameras, double width_m) {
    std::vector<DepthView> views;
    const StageCamera middle = rig_camera(0);
    const double step_m = width_m / (cameras.width - 1);
    for (int j = 0; j < cameras.height; ++j)
        for (int i = 0; i < cameras.width; ++i) {
            StageCamera camera = middle;
            const Eigen::Vector3d aside(step_m * (i - 0.5 * (cameras.width - 1)),
                                        step_m * (j - 0.5 * (cameras.height - 1)), 0);
            camera.world_from_camera.translation() += middle.world_from_camera.linear() * aside;
            views.push_back(film(stage, camera, fmt::format("{}-{}", i, j), moment));
        }
    return views;
}

Case held_out(const std::filesystem::path& folder, const std::string& scene,
              const std::string& name) {
    Case one;
    one.name = scene.substr(0, scene.find('_')) + ", " + name;
    ViewSet set = load_view_set(folder / scene);
    const auto index = static_cast<std::ptrdiff_t>(set.index_of(name));
    one.truth = set.views[static_cast<std::size_t>(index)];
    set.views.erase(set.views.begin() + index);
    one.views = std::move(set.views);
    return one;
}

struct Result {
    ColourImage picture;
    double ms = 0;        ///< of an instant and a picture
    std::string refusal;  ///< why there is no picture; empty: there is
};

Result run_system(const std::string& name, const Case& one, const ShaderLibrary& shaders,
                  bool is_timed = false) {
    Synthesiser synthesiser(find_synthesiser(name), shaders);
    const double dt_s = std::chrono::duration<double>(between_instants).count();
    for (const std::vector<DepthView>& views : one.before) synthesiser.set_views(views, dt_s);
    const VirtualView target{one.truth.colour.cols, one.truth.colour.rows, one.truth.K,
                             one.truth.world_from_camera};
    Result result;
    const auto whole = [&] {
        synthesiser.set_views(one.views, dt_s);
        result.picture = synthesiser.render(target).download();
    };
    try {
        whole();
    } catch (const Error& error) {
        result.refusal = error.what();
        return result;
    }
    if (is_timed) result.ms = median_gpu_ms(repeats, whole);
    return result;
}

std::string worth(const Result& result, const Case& one) {
    if (!result.refusal.empty()) return " – |";
    if (!one.truth.depth_m.empty())
        return fmt::format(" {:.1f} dB, {:.3f}, {:.0f} %, {:.1f} |",
                           psnr_db(result.picture, one.truth.colour),
                           ssim(result.picture, one.truth.colour), 100 * coverage(result.picture),
                           mean_error(result.picture, one.truth.colour,
                                      depth_edge_band(one.truth.depth_m, edge_band_px) &
                                          covered_mask(result.picture)));
    return fmt::format(" {:.1f} dB, {:.3f}, {:.0f} % |", psnr_db(result.picture, one.truth.colour),
                       ssim(result.picture, one.truth.colour), 100 * coverage(result.picture));
}

/// Into the strip of its system, whatever its options: the picture, and what is wrong with it.
void show(std::map<std::string, PictureSheet>& strips, const std::string& system, const Case& one,
          const ColourImage& picture) {
    const std::string name = system.substr(0, system.find(':'));
    PictureSheet& strip = strips.try_emplace(name, picture_size, strip_columns).first->second;
    strip.add(fmt::format("{}: {}", system, one.name), picture);
    strip.add("differences, times four", difference_picture(picture, one.truth.colour));
}

int run(int argc, char** argv) {
    CLI::App app("What the gallery's systems are worth");
    std::string documents, picture, folder;
    std::vector<std::string> only;
    CLI::Option* docs =
        app.add_option("--docs", documents,
                       "Folder of the documents whose tables and contact sheet are written anew");
    app.add_option("--only", only, "Of these systems alone")->excludes(docs);
    app.add_option("--picture", picture, "Contact sheet to write (.jpg or .png)");
    app.add_option("--folder", folder, "Where every picture goes by itself (.png)");
    CLI11_PARSE(app, argc, argv);

    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage{shaders};
    std::vector<Case> cases;
    if (const auto data = data_folder()) {
        cases.push_back(held_out(*data / "viewsets", "aloe_half", "view3"));
        cases.push_back(held_out(*data / "viewsets", "teddy", "im4"));
    }
    cases.push_back(on_stage(stage, 20));
    const std::size_t shown = cases.size() - 1;
    cases.push_back(on_stage(stage, 40));

    // A light field of as many cameras as it takes, as wide as two of the rigs stand apart.
    Case grid = cases[shown];
    grid.before.clear();
    const double width_m = (rig_camera(10).world_from_camera.translation() -
                            rig_camera(-10).world_from_camera.translation())
                               .norm();
    grid.views = film_grid(stage, {8, 4}, width_m);

    std::ostringstream text;
    text << fmt::format("Measured on {}.\n\n", GlInfo::query().renderer)
         << "A cell has PSNR and SSIM over all pixels, and the coverage. On the stage it also has "
            "the mean error, of 255, of covered pixels within 2 px of depth edges. The stage has "
            "four rigs of 320x240 with exact depth, as far apart as the column says. The view is "
            "midway between the middle two. There are "
         << instants_before
         << " instants before it, half a second apart. The column ms is for an instant and a "
            "picture of the stage at 20 degrees.\n\n| system |";
    for (const Case& one : cases) text << " " << one.name << " |";
    text << " ms |\n| --- |";
    for (std::size_t i = 0; i <= cases.size(); ++i) text << " --- |";
    text << "\n";
    PictureSheet sheet(picture_size, sheet_columns);
    std::map<std::string, PictureSheet> strips;
    std::vector<std::string> refusals;
    for (std::size_t i = 0; i < cases.size() && !folder.empty(); ++i)
        write_colour_image(fmt::format("{}/truth-{}.png", folder, i), cases[i].truth.colour);
    for (const std::string& system : only.empty() ? systems() : only) {
        text << fmt::format("| `{}` |", system);
        double ms = 0;
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Result result = run_system(system, cases[i], shaders, i == shown);
            text << worth(result, cases[i]);
            if (!result.refusal.empty())
                refusals.push_back(fmt::format("- {}: {}.", cases[i].name, result.refusal));
            else if (!folder.empty())
                write_colour_image(fmt::format("{}/{}-{}.png", folder, system, i), result.picture);
            if (i >= shown && result.refusal.empty())
                show(strips, system, cases[i], result.picture);
            if (i == shown) {
                ms = result.ms;
                if (result.refusal.empty() && !system.starts_with("lightfield"))
                    sheet.add(system, result.picture);
            }
        }
        text << fmt::format(" {:.0f} |\n", ms);
    }
    const std::string systems_table = text.str();
    text << "\nWithout a picture:\n\n";
    for (const std::string& refusal : refusals) text << refusal << "\n";

    if (!only.empty()) {
        std::cout << text.str();
        return 0;
    }

    text << fmt::format(
        "\n### How many cameras depth replaces\n\nThe same view of the stage, from a grid of "
        "cameras that is {:.2f} m wide. All look the same way.\n\n| cameras | `lightfield` | "
        "`lightfield:rays=corrected` |\n| --- | --- | --- |\n",
        width_m);
    for (const cv::Size cameras :
         {cv::Size(2, 2), cv::Size(4, 2), cv::Size(8, 4), cv::Size(16, 8)}) {
        grid.views = film_grid(stage, cameras, width_m);
        text << fmt::format("| {} x {} |", cameras.width, cameras.height);
        for (const char* system : {"lightfield", "lightfield:rays=corrected"}) {
            const Result result = run_system(system, grid, shaders);
            text << worth(result, grid);
            if (cameras == cv::Size(8, 4))
                sheet.add(fmt::format("{}, 8 x 4 cameras", system), result.picture);
        }
        text << "\n";
    }
    sheet.add("truth", grid.truth.colour);

    std::cout << text.str();
    if (!picture.empty()) write_colour_image(picture, sheet.picture());
    if (!documents.empty()) {
        put_between_markers(documents + "/results/gallery.md", text.str());
        put_between_markers(documents + "/gallery.md", systems_table);
        write_colour_image(documents + "/pictures/gallery.jpg", sheet.picture());
        for (const auto& [system, strip] : strips)
            write_colour_image(fmt::format("{}/pictures/gallery/{}.jpg", documents, system),
                               strip.picture());
    }
    return 0;
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    return vantage::run_bench("gallery_bench", [&] { return vantage::run(argc, argv); });
}
