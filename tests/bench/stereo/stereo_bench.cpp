// Quality and time of the presets beside OpenCV's matchers, as the tables of
// docs/results/stereo.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <unistd.h>

#include "common/base/error.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/gpu_timer.h"
#include "common/image/colour_map.h"
#include "common/image/image_file.h"
#include "rig_firmware/stereo/matcher.h"
#include "tests/bench/stereo/opencv_matchers.h"
#include "tests/bench/stereo/plain_surface_table.h"
#include "tests/bench/stereo/stereo_scenes.h"
#include "tests/bench/stereo/stereo_stage_tables.h"
#include "tests/bench/stereo/still_film_table.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/markdown_tables.h"
#include "tests/bench/support/printed_text.h"
#include "tests/bench/support/run_bench.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

struct Preset {
    const char* name;
    MatchPreset preset;
};
constexpr Preset presets[] = {{"quality", MatchPreset::quality},
                              {"balanced", MatchPreset::balanced},
                              {"fast", MatchPreset::fast}};

double resident_mb() {
    long pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// A matcher with its input textures, for one size.
class Bench {
  public:
    Bench(const ShaderLibrary& library, const std::string& matcher, MatchPreset preset,
          cv::Size size, int disparities)
        : left_(TextureFormat::rgba8, size.width, size.height),
          right_(TextureFormat::rgba8, size.width, size.height),
          matcher_(make_matcher(matcher.empty() ? default_matcher(preset) : matcher, library,
                                {size.width, size.height, disparities, preset, true})) {}

    void upload(const StereoScene& scene) {
        left_.upload(scene.left);
        right_.upload(scene.right);
    }
    const Texture& run() {
        const Texture& result = matcher_->match(left_, right_);
        glFinish();
        return result;
    }
    cv::Mat1f disparity() { return to_float_px(run().download()); }
    std::size_t gpu_bytes() const { return matcher_->gpu_bytes(); }

  private:
    Texture left_, right_;
    std::unique_ptr<Matcher> matcher_;
};

/// Bad pixels in percent.
struct Shares {
    double way = 0, hh4 = 0, bm = 0;
    double ours[std::size(presets)] = {};

    double best() const { return std::max(std::min(way, hh4), 0.01); }
};

struct Quality {
    Shares of_both;       ///< of what both cameras see
    Shares of_left_only;  ///< of what only the left one sees
};

Quality judge(const ShaderLibrary& library, const std::string& matcher, const StereoScene& scene,
              const std::string& pictures) {
    const GreyImage left = to_grey(scene.left), right = to_grey(scene.right);
    const cv::Mat1b left_only = seen_by_left_only(scene);
    Quality q;
    const auto judge_one = [&](const cv::Mat1f& d, double& of_both, double& of_left_only) {
        of_both = 100 * bad_share(d, scene, scene.non_occluded, 2);
        of_left_only = 100 * bad_share(d, scene, left_only, 2);
    };
    const auto judge_opencv = [&](OpenCvMode mode, double Shares::*share) {
        judge_one(OpenCvMatcher(mode, scene.disparities).match(left, right, true), q.of_both.*share,
                  q.of_left_only.*share);
    };
    judge_opencv(OpenCvMode::sgbm_3way, &Shares::way);
    judge_opencv(OpenCvMode::hh4, &Shares::hh4);
    judge_opencv(OpenCvMode::bm, &Shares::bm);
    const auto picture = [&](const std::string& name, const cv::Mat1f& d) {
        if (!pictures.empty())
            write_colour_image(pictures + "/" + scene.name + "_" + name + ".png",
                               colour_map_disparity(d, 1, static_cast<float>(scene.disparities)));
    };
    picture("truth", scene.disparity_px);
    for (std::size_t i = 0; i < std::size(presets); ++i) {
        Bench bench(library, matcher, presets[i].preset, scene.left.size(), scene.disparities);
        bench.upload(scene);
        const cv::Mat1f d = bench.disparity();
        judge_one(d, q.of_both.ours[i], q.of_left_only.ours[i]);
        picture(presets[i].name, d);
    }
    return q;
}

/// Errors of the presets against OpenCV's better, over several scenes.
class Verdict {
  public:
    void add(const Shares& q) {
        const double best = q.best();
        ++scenes_;
        best_sum_ += best;
        for (std::size_t i = 0; i < std::size(presets); ++i) {
            sums_[i] += q.ours[i];
            ratio_sums_[i] += q.ours[i] / best;
        }
    }
    void print(std::string_view set) const {
        if (scenes_ == 0) return;
        const auto row = [&](const char* how, const auto& ratio) {
            fmt::print("| **{} ({}), {}** | | | | | | | **{:.2f}** | **{:.2f}** | **{:.2f}** |\n",
                       set, scenes_, how, ratio(0), ratio(1), ratio(2));
        };
        row("ratio of means", [&](int i) { return sums_[i] / best_sum_; });
        row("mean of ratios", [&](int i) { return ratio_sums_[i] / scenes_; });
    }
    int scenes() const { return scenes_; }

  private:
    double sums_[std::size(presets)] = {}, ratio_sums_[std::size(presets)] = {}, best_sum_ = 0;
    int scenes_ = 0;
};

const char* mark_of(SceneUse use) {
    switch (use) {
        case SceneUse::tuning:
            return " (t)";
        case SceneUse::in_sight:
            return " (s)";
        default:
            return "";
    }
}

void print_quality(const ShaderLibrary& library, const std::string& matcher,
                   const std::vector<StereoScene>& scenes, const std::string& pictures) {
    fmt::print(
        "Per cent of pixels whose disparity is off by more than 2 px (bad-2.0), of all known "
        "pixels that both cameras see. Scenes marked (t) chose settings; scenes marked (s) were "
        "looked at meanwhile.\n\n"
        "| scene | BM | 3WAY | HH4 | quality | balanced | fast | quality / best | balanced / best "
        "| fast / best |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    Verdict photographs, generated, held_out, tuning;
    std::string left_only;
    for (const StereoScene& scene : scenes) {
        const Quality quality = judge(library, matcher, scene, pictures);
        const Shares &q = quality.of_both, &of_left = quality.of_left_only;
        left_only += fmt::format("| {}{} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n",
                                 scene.name, mark_of(scene.use), of_left.way, of_left.hh4,
                                 of_left.ours[0], of_left.ours[1], of_left.ours[2]);
        fmt::print(
            "| {}{} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | "
            "{:.2f} |\n",
            scene.name, mark_of(scene.use), q.bm, q.way, q.hh4, q.ours[0], q.ours[1], q.ours[2],
            q.ours[0] / q.best(), q.ours[1] / q.best(), q.ours[2] / q.best());
        std::cout.flush();
        if (scene.use == SceneUse::tuning || scene.use == SceneUse::in_sight) {
            tuning.add(q);
            continue;
        }
        held_out.add(q);
        (scene.use == SceneUse::held_out ? photographs : generated).add(q);
    }
    if (photographs.scenes() > 0 && generated.scenes() > 0)
        held_out.print("scenes that tuning did not use");
    photographs.print("photographs that tuning did not use");
    generated.print("generated scenes");
    tuning.print("scenes that tuning used");
    fmt::print(
        "\nThe same for pixels that only the left camera sees, which each matcher fills.\n\n"
        "| scene | 3WAY | HH4 | quality | balanced | fast |\n"
        "| --- | --- | --- | --- | --- | --- |\n{}\n",
        left_only);
}

void print_times(const ShaderLibrary& library, const std::string& matcher, const StereoScene& scene,
                 int repeats) {
    const GreyImage left = to_grey(scene.left), right = to_grey(scene.right);
    OpenCvMatcher bm(OpenCvMode::bm, scene.disparities),
        way(OpenCvMode::sgbm_3way, scene.disparities), hh4(OpenCvMode::hh4, scene.disparities);
    std::vector<std::unique_ptr<Bench>> benches;
    std::vector<std::function<void()>> runs = {[&] { bm.match(left, right, false); },
                                               [&] { way.match(left, right, false); },
                                               [&] { hh4.match(left, right, false); }};
    for (const Preset& preset : presets) {
        benches.push_back(std::make_unique<Bench>(library, matcher, preset.preset,
                                                  scene.left.size(), scene.disparities));
        benches.back()->upload(scene);
        runs.emplace_back([bench = benches.back().get()] { bench->run(); });
    }
    std::vector<double> least(runs.size(), std::numeric_limits<double>::max());
    for (int repeat = -1; repeat < repeats; ++repeat)  // the first warms up
        for (std::size_t i = 0; i < runs.size(); ++i) {
            const double begin = cpu_ms();
            runs[i]();
            if (repeat >= 0) least[i] = std::min(least[i], cpu_ms() - begin);
        }
    fmt::print(
        "| {}x{}x{} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | "
        "{:.2f} |\n",
        scene.left.cols, scene.left.rows, scene.disparities, least[0], least[1], least[2], least[3],
        least[4], least[5], least[3] / least[2], least[4] / least[1], least[5] / least[1]);
}

StereoScene altered(const StereoScene& scene, const std::string& how) {
    StereoScene result = scene;
    result.name = scene.name + ", " + how;
    result.right = scene.right.clone();
    for (int y = 0; y < result.right.rows; ++y)
        for (int x = 0; x < result.right.cols; ++x) {
            if (how == "1 px lower") {
                result.right(y, x) = scene.right(std::max(y - 1, 0), x);
                continue;
            }
            for (int c = 0; c < 3; ++c) {
                const double level = scene.right(y, x)[c];
                result.right(y, x)[c] = cv::saturate_cast<unsigned char>(
                    how == "exposure x 0.6" ? level * 0.6 : 255 * std::pow(level / 255, 0.7) + 5);
            }
        }
    return result;
}

void print_robustness(const ShaderLibrary& library, const std::string& matcher,
                      const std::vector<StereoScene>& scenes) {
    fmt::print(
        "An altered right picture: bad-2.0 with it, less bad-2.0 of the original pair, in "
        "points.\n\n"
        "| scene | HH4 | HH4, cap 63 | quality | balanced | fast |\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    const auto hh4_with_cap_63 = [](const StereoScene& scene) {
        constexpr int cap = 63;
        return 100 * bad_share(OpenCvMatcher(OpenCvMode::hh4, scene.disparities, cap)
                                   .match(to_grey(scene.left), to_grey(scene.right), true),
                               scene, scene.non_occluded, 2);
    };
    for (const StereoScene& scene : scenes) {
        const bool wanted = scene.name == "teddy" || scene.name.starts_with("aloe");
        if (!wanted) continue;
        const Shares as_it_was = judge(library, matcher, scene, "").of_both;
        for (const char* how : {"exposure x 0.6", "gamma 0.7", "1 px lower"}) {
            const StereoScene other = altered(scene, how);
            const Shares q = judge(library, matcher, other, "").of_both;
            fmt::print("| {} | {:+.2f} | {:+.2f} | {:+.2f} | {:+.2f} | {:+.2f} |\n", other.name,
                       q.hh4 - as_it_was.hh4, hh4_with_cap_63(other) - hh4_with_cap_63(scene),
                       q.ours[0] - as_it_was.ours[0], q.ours[1] - as_it_was.ours[1],
                       q.ours[2] - as_it_was.ours[2]);
        }
    }
    fmt::print("\n");
}

/// What a preset's matcher takes for the largest pictures of the rigs' sensors, measured in a
/// process of its own: where another matcher ran before, freed memory would be used again and not
/// grow.
void print_memory_of(MatchPreset preset, const std::string& matcher) {
    constexpr int width = 1456, height = 1088, disparities = 128;
    const EglContext context;
    const ShaderLibrary library;
    const double before = resident_mb();
    Bench bench(library, matcher, preset, {width, height}, disparities);
    bench.run();
    bench.run();
    const double gl = static_cast<double>(bench.gpu_bytes()) / 1e6, grown = resident_mb() - before;
    // Where the CPU draws, GL objects are part of the resident memory.
    const bool counted_already = GlInfo::query().renderer.find("llvmpipe") != std::string::npos;
    fmt::print("| {:.0f} | {:.0f} | {:.0f} |\n", gl, grown, counted_already ? grown : gl + grown);
}

/// What the matching takes on the GPU, at the sizes of a demo's rig and of a global-shutter camera.
void print_gpu_times(const ShaderLibrary& library, const std::string& matcher, int repeats) {
    fmt::print(
        "GPU time, ms, median of {}; of a generated scene\n\n"
        "| size | quality | balanced | fast |\n| --- | --- | --- | --- |\n",
        repeats);
    for (const RandomSceneLook& look : {RandomSceneLook{.width_px = 960, .height_px = 720},
                                        RandomSceneLook{.width_px = 1456, .height_px = 1088}}) {
        const StereoScene scene = make_random_scene(first_held_out_seed, look, {});
        fmt::print("| {}x{}x{} |", scene.left.cols, scene.left.rows, scene.disparities);
        for (const Preset& preset : presets) {
            Bench bench(library, matcher, preset.preset, scene.left.size(), scene.disparities);
            bench.upload(scene);
            bench.run();
            fmt::print(" {:.2f} |", median_gpu_ms(repeats, [&] { bench.run(); }));
            std::fflush(stdout);
        }
        fmt::print("\n");
    }
}

void print_memory(const std::string& matcher) {
    fmt::print(
        "| memory at 1456x1088x128 | GL objects, MB | resident growth, MB | together, each byte "
        "once, MB |\n| --- | --- | --- | --- |\n");
    for (const Preset& preset : presets) {
        fmt::print("| {} ", preset.name);
        std::fflush(stdout);
        const std::string command = fmt::format(
            "'{}' --memory-of {} --matcher '{}'",
            std::filesystem::read_symlink("/proc/self/exe").string(), preset.name, matcher);
        if (std::system(command.c_str()) != 0)
            fail("the memory of {} could not be measured: '{}' failed", preset.name, command);
    }
    fmt::print("\n");
}

int run(int argc, char** argv) {
    CLI::App app("Quality and time of the stereo presets beside OpenCV's matchers");
    std::string data = data_folder().value_or("").string(), pictures, matcher, only, memory_of;
    int repeats = 11, random_scenes = 6;
    std::uint64_t first_seed = first_held_out_seed;
    bool no_times = false, gpu_times = false, only_plain = false, only_films = false;
    std::string document, stage_picture;
    app.add_option("--write", document, "Markdown file whose tables are written anew");
    app.add_option("--stage-picture", stage_picture,
                   "comparison on the virtual stage to write (.jpg or .png)");
    app.add_option("--data", data, "folder with the stereo data");
    app.add_option("--pictures", pictures, "write colour-mapped disparities to this folder");
    app.add_option("--matcher", matcher, "use this matcher for all presets");
    app.add_option("--repeats", repeats, "interleaved repeats of the timing")
        ->check(CLI::Range(1, 1000));
    app.add_option("--only", only, "judge scenes whose name has this in it");
    app.add_option("--random-scenes", random_scenes, "generated scenes to judge as well");
    app.add_option("--first-seed", first_seed, "of the generated scenes");
    app.add_flag("--quality-only", no_times, "leave out times, memory and robustness");
    app.add_flag("--only-plain", only_plain, "print only the table of plain surfaces");
    app.add_flag("--only-films", only_films, "print only the tables of films");
    app.add_flag("--gpu-times", gpu_times, "print only what matching takes on the GPU");
    app.add_option("--memory-of", memory_of, "print only this preset's memory, as a row's end");
    CLI11_PARSE(app, argc, argv);
    if (!memory_of.empty()) {
        print_memory_of(parse_preset(memory_of), matcher);
        return 0;
    }

    // Threads that share a core count their waiting for each other as CPU time; HH4 has but one.
    // llvmpipe asks when a context is made.
    setenv("LP_NUM_THREADS", "1", 0);
    cv::setNumThreads(1);
    const EglContext context;
    const ShaderLibrary library;
    if (gpu_times) {
        fmt::print("{}\n\n", GlInfo::query().renderer);
        print_gpu_times(library, matcher, repeats);
        return 0;
    }
    if (only_films) {
        print_still_film_table(library);
        return 0;
    }
    std::optional<PrintedText> printed;
    if (!document.empty()) printed.emplace();
    const auto write_document = [&] {
        if (printed) put_between_markers(document, printed->text());
    };
    fmt::print("{}, OpenCV {}\n\n", GlInfo::query().renderer, CV_VERSION);
    std::vector<StereoScene> scenes;
    if (!data.empty()) scenes = load_stereo_scenes(data);
    const auto photographs =
        data.empty() ? std::vector<ColourImage>() : load_texture_photographs(data);
    for (int i = 0; i < random_scenes; ++i)
        scenes.push_back(
            make_random_scene(first_seed + static_cast<std::uint64_t>(i), {}, photographs));
    if (!only.empty())
        std::erase_if(scenes, [&](const StereoScene& scene) {
            return scene.name.find(only) == std::string::npos;
        });
    if (!pictures.empty()) std::filesystem::create_directories(pictures);
    if (only_plain) {
        print_plain_surface_table(library, scenes);
        return 0;
    }
    print_quality(library, matcher, scenes, pictures);
    print_plain_surface_table(library, scenes);
    print_still_film_table(library);
    print_stage_tables(library, stage_picture);
    if (no_times) {
        write_document();
        return 0;
    }

    fmt::print(
        "Processor time of one thread in ms, the least of {} interleaved repeats.\n\n"
        "| size | BM | 3WAY | HH4 | quality | balanced | fast | quality / HH4 | balanced / 3WAY | "
        "fast / 3WAY |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        repeats);
    for (const RandomSceneLook& look : {RandomSceneLook{.width_px = 450, .height_px = 375},
                                        RandomSceneLook{.width_px = 640, .height_px = 480}})
        print_times(library, matcher, make_random_scene(first_seed, look, photographs), repeats);
    fmt::print("\n");
    print_robustness(library, matcher, scenes);
    print_memory(matcher);
    write_document();
    return 0;
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    return vantage::run_bench("stereo_bench", [&] { return vantage::run(argc, argv); });
}
