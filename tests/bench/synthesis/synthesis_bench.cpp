// Quality and time of the synthesisers: writes the tables of docs/results/synthesis.md between its
// markers, and a comparison picture beside it.
#include <algorithm>
#include <functional>
#include <iostream>
#include <map>
#include <span>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/gpu_timer.h"
#include "common/image/image_file.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "host_app/view_sets/view_set.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/markdown_tables.h"
#include "tests/bench/support/run_bench.h"
#include "tests/bench/synthesis/own_matching_table.h"
#include "tests/support/data_folder.h"
#include "tests/support/stage_camera_at.h"

namespace vantage {
namespace {

constexpr int repeats = 5;

std::vector<DepthView> film(VirtualStage& stage, const std::vector<double>& azimuths_deg,
                            cv::Size size) {
    std::vector<DepthView> views;
    for (const double azimuth_deg : azimuths_deg)
        views.push_back(exact_view_at(stage, azimuth_deg, size.width, size.height));
    return views;
}

VirtualView target_of(const DepthView& view) {
    return {view.colour.cols, view.colour.rows, view.K, view.world_from_camera};
}

/// The product's own and those of the gallery that they are measured against, by name.
std::vector<SynthesiserEntry> compared() {
    std::vector<SynthesiserEntry> entries;
    for (const char* name : {"fused", "layered", "mesh", "points"})
        entries.push_back(find_synthesiser(name));
    return entries;
}

/// What else the machine does only adds to a time.
struct LeastTimes {
    double wall_ms = 1e9, cpu_ms = 1e9;

    void run(const std::function<void()>& work) {
        const double before_ms = vantage::cpu_ms();
        wall_ms = std::min(wall_ms, median_gpu_ms(1, work));
        cpu_ms = std::min(cpu_ms, vantage::cpu_ms() - before_ms);
    }
};

class Bench {
  public:
    void held_out_views(const std::filesystem::path& data) {
        text_ << "### Real pictures, one view held out\n\n"
                 "The pictures come from the two views with ground-truth disparity (`vantage "
                 "render --hold-out`).\n\n"
                 "| scene, view | synthesiser | PSNR dB | covered only | SSIM | coverage |\n"
                 "| --- | --- | --- | --- | --- | --- |\n";
        for (const auto& [scene, name] :
             {std::pair("aloe_half", "view3"), std::pair("aloe_half", "view0"),
              std::pair("aloe_half", "view6"), std::pair("teddy", "im4"), std::pair("teddy", "im3"),
              std::pair("teddy", "im5")}) {
            ViewSet set = load_view_set(data / "viewsets" / scene);
            const auto index = static_cast<std::ptrdiff_t>(set.index_of(name));
            const DepthView truth = set.views[static_cast<std::size_t>(index)];
            set.views.erase(set.views.begin() + index);
            for (const SynthesiserEntry& entry : compared())
                score(entry, fmt::format("{}, {}", scene, name), set.views, truth);
        }
    }

    void stage_views() {
        text_ << "\n### The virtual stage, exact depth, 320x240\n\n"
                 "Halo is the mean error in a 5 px band around depth edges, relative to "
                 "`mesh`.\n\n"
                 "| rigs at, view at (degrees) | synthesiser | PSNR dB | covered only | SSIM | "
                 "coverage | halo |\n| --- | --- | --- | --- | --- | --- | --- |\n";
        struct Case {
            const char* rigs;
            std::vector<double> azimuths_deg;
            double view_deg;
        };
        for (const Case& one :
             {Case{"±15, ±45", {-45, -15, 15, 45}, 0}, Case{"±15, ±45", {-45, -15, 15, 45}, -30},
              Case{"±15, ±45", {-45, -15, 15, 45}, 30}, Case{"±20, ±60", {-60, -20, 20, 60}, 0},
              Case{"±4", {-4, 4}, 0}}) {
            const auto views = film(stage_, one.azimuths_deg, {320, 240});
            const DepthView truth = exact_view_at(stage_, one.view_deg, 320, 240);
            const cv::Mat1b band = depth_edge_band(truth.depth_m, 5);
            std::map<std::string, ColourImage> pictures;
            for (const SynthesiserEntry& entry : compared())
                pictures[entry.name] = picture(entry, views, truth);
            for (const auto& [name, picture] : pictures) {
                const cv::Mat1b seen =
                    band & covered_mask(picture) & covered_mask(pictures["mesh"]);
                row(fmt::format("{}; {:g}", one.rigs, one.view_deg), name, picture, truth);
                text_ << fmt::format(" {:.2f} |\n",
                                     mean_error(picture, truth.colour, seen) /
                                         mean_error(pictures["mesh"], truth.colour, seen));
            }
            if (comparison_.empty()) compare(pictures, truth);
        }
    }

    void own_matching() { text_ << own_matching_table(shaders_); }

    void times() {
        text_ << "\n### Time against the number of rigs\n\n"
                 "Rigs of 640x480 stand around the stage. `render` is a picture of the present "
                 "instant, and `+ depth` adds a new instant of all rigs. Backgrounds are learnt "
                 "and shown. The first column is the wall time of the GPU's work, in ms. The "
                 "column CPU is the processor's time, since a software renderer shares its "
                 "processor. Each value is the least of "
              << repeats
              << ", for which the numbers of rigs take turns.\n\n"
                 "| output | synthesiser | rigs | render | CPU | + depth | CPU |\n"
                 "| --- | --- | --- | --- | --- | --- | --- |\n";
        for (const cv::Size size : {cv::Size(1280, 720), cv::Size(1920, 1080)})
            for (const char* name : {"mesh", "fused"}) times(size, name);
    }

    void times(cv::Size size, const char* name) {
        const std::vector<DepthView> all =
            film(stage_, {-15, 15, -45, 45, -30, 30, -60, 60}, {640, 480});
        const StageCamera camera = camera_at(0, size.width, size.height);
        const VirtualView target{size.width, size.height, camera.K, camera.world_from_camera};
        struct Timed {
            std::span<const DepthView> views;
            std::unique_ptr<Synthesiser> synthesiser;
            LeastTimes render{}, with_depth{};
        };
        std::vector<Timed> ones;
        for (const std::size_t rigs : {1u, 2u, 4u, 8u}) {
            ones.push_back({std::span(all).first(rigs), make_synthesiser(name, shaders_)});
            const Timed& one = ones.back();
            one.synthesiser->set_views(one.views);
            one.synthesiser->render(target);
        }
        for (int i = 0; i < repeats; ++i)
            for (Timed& one : ones) {
                one.render.run([&] { one.synthesiser->render(target); });
                one.with_depth.run([&] {
                    one.synthesiser->set_views(one.views);
                    one.synthesiser->render(target);
                });
            }
        for (const Timed& one : ones)
            text_ << fmt::format("| {}x{} | {} | {} | {:.1f} | {:.0f} | {:.1f} | {:.0f} |\n",
                                 size.width, size.height, name, one.views.size(),
                                 one.render.wall_ms, one.render.cpu_ms, one.with_depth.wall_ms,
                                 one.with_depth.cpu_ms);
    }

    std::string tables() const {
        return fmt::format("Measured on {}.\n\n", GlInfo::query().renderer) + text_.str();
    }
    const ColourImage& comparison() const { return comparison_; }

  private:
    ColourImage picture(const SynthesiserEntry& entry, const std::vector<DepthView>& views,
                        const DepthView& truth) {
        Synthesiser synthesiser(entry, shaders_);
        synthesiser.set_views(views);
        return synthesiser.render(target_of(truth)).download();
    }

    void row(const std::string& what, const std::string& name, const ColourImage& picture,
             const DepthView& truth) {
        text_ << fmt::format("| {} | {} | {:.2f} | {:.2f} | {:.3f} | {:.3f} |", what, name,
                             psnr_db(picture, truth.colour),
                             psnr_db(picture, truth.colour, covered_mask(picture)),
                             ssim(picture, truth.colour), coverage(picture));
    }

    void score(const SynthesiserEntry& entry, const std::string& what,
               const std::vector<DepthView>& views, const DepthView& truth) {
        row(what, entry.name, picture(entry, views, truth), truth);
        text_ << "\n";
    }

    /// The synthesisers' pictures in a row, the truth last; their differences from it below.
    void compare(const std::map<std::string, ColourImage>& pictures, const DepthView& truth) {
        std::vector<cv::Mat> above, below;
        for (const auto& [name, picture] : pictures) {
            above.push_back(picture);
            below.push_back(difference_picture(picture, truth.colour));
        }
        above.push_back(truth.colour);
        below.push_back(ColourImage(truth.colour.size(), cv::Vec4b(0, 0, 0, 255)));
        cv::Mat rows[2], both;
        cv::hconcat(above, rows[0]);
        cv::hconcat(below, rows[1]);
        cv::vconcat(rows[0], rows[1], both);
        comparison_ = both;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    VirtualStage stage_{shaders_};
    std::ostringstream text_;
    ColourImage comparison_;
};

int run(int argc, char** argv) {
    CLI::App app("Quality and time of the synthesisers");
    std::string document, picture;
    bool without_times = false, stage_only = false;
    app.add_option("--write", document, "Markdown file whose tables are written anew");
    app.add_option("--picture", picture, "Comparison picture to write (.jpg or .png)");
    app.add_flag("--without-times", without_times, "Quality only");
    app.add_flag("--stage-only", stage_only, "Of the virtual stage, without real pictures");
    CLI11_PARSE(app, argc, argv);
    Bench bench;
    if (const auto data = data_folder(); data && !stage_only) bench.held_out_views(*data);
    bench.stage_views();
    bench.own_matching();
    if (!without_times) bench.times();
    std::cout << bench.tables();
    if (!picture.empty()) write_colour_image(picture, bench.comparison());
    if (!document.empty()) put_between_markers(document, bench.tables());
    return 0;
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    return vantage::run_bench("synthesis_bench", [&] { return vantage::run(argc, argv); });
}
