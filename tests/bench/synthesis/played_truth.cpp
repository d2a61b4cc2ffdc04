#include "tests/bench/synthesis/played_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/time/time.h"
#include "common/config/stage_config.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/image/image_file.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/session/live_show.h"
#include "host_app/session/report/live_report.h"
#include "tests/bench/synthesis/fidelity.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

/// Of a good camera, in grey levels; the demo's have none.
constexpr double noise_sigma = 1;

/// Seconds since the start of the move's first loop, between which pictures are counted apart: the
/// background is learnt meanwhile.
constexpr std::array<double, 6> spans_s = {0, 1, 2, 5, 10, 12};
/// Loops from which on the background counts as known.
constexpr int known_from_loop = 2;

struct Shown {
    ColourImage picture;
    CameraState camera;
    TaiTime exposure, handed_over;
};

/// Keeps what the programme hands out, and when.
class KeepingSink final : public PictureSink {
  public:
    explicit KeepingSink(std::vector<Shown>& into) : into_(&into) {}
    std::string name() const override { return "measurement"; }
    void take(const ProgrammePicture& picture) override {
        for (const FrameSet::Slot& slot : picture.set->slots)
            if (slot.frame) {
                into_->push_back(
                    {picture.picture, picture.camera, slot.frame->exposure, TaiClock::now()});
                return;
            }
    }

  private:
    std::vector<Shown>* into_;
};

/// The rigs of `vantage demo`, until this goes.
class DemoRigs {
  public:
    DemoRigs() {
        program_ = std::make_unique<ChildProgram>(
            program_folder() / "vantage",
            std::vector<std::string>{"demo", "--rigs-only", "--folder", folder_.path()},
            folder_.path());
        for (int tries = 0; tries < 600; ++tries) {
            const std::string out = program_->out(), mark = "ready: ";
            if (const auto at = out.find(mark); at != std::string::npos) {
                stage_ = out.substr(at + mark.size(), out.find('\n', at) - at - mark.size());
                return;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        fail("the demo's rigs did not start within a minute: {}", program_->err());
    }
    ~DemoRigs() {
        program_->send_signal(SIGTERM);
        (void)program_->wait();
    }
    const std::string& stage() const { return stage_; }

  private:
    TemporaryFolder folder_;
    std::unique_ptr<ChildProgram> program_;
    std::string stage_;
};

struct Played {
    std::vector<Shown> shown;
    LiveReport report;
};

/// Fidelity at the same places of a looping move: in its first loop, and in those from
/// known_from_loop on. The place decides more than time does.
class AlongMove {
  public:
    explicit AlongMove(double loop_s) : loop_s_(loop_s) {}

    void add(double at_s, const ColourImage& picture, const ColourImage& truth) {
        const double loop = std::floor(at_s / loop_s_);
        if (loop > 0 && loop < known_from_loop) return;
        const double in_loop_s = at_s - loop * loop_s_;
        const auto span = std::upper_bound(spans_s.begin(), spans_s.end(), in_loop_s);
        if (span == spans_s.end()) return;
        Fidelities& of = loop == 0 ? first_ : later_;
        of.at(static_cast<std::size_t>(span - spans_s.begin() - 1)).add(picture, truth);
        if (in_loop_s < sum_until_s) (loop == 0 ? first_sum_ : later_sum_).add(picture, truth);
    }
    std::string table() const {
        std::string table =
            "| seconds of the move | PSNR dB, SSIM, outlier pixels in the first loop | from the "
            "third "
            "loop on |\n| --- | --- | --- |\n";
        for (std::size_t i = 0; i < first_.size(); ++i)
            table +=
                row(fmt::format("{:g} to {:g}", spans_s[i], spans_s[i + 1]), first_[i], later_[i]);
        return table + row(fmt::format("0 to {:g}", sum_until_s), first_sum_, later_sum_) + "\n";
    }

  private:
    using Fidelities = std::array<Fidelity, spans_s.size() - 1>;
    static constexpr double sum_until_s = 10;

    static std::string row(const std::string& name, const Fidelity& first, const Fidelity& later) {
        const auto cell = [](const Fidelity& of) {
            return of.pictures() == 0 ? std::string("none")
                                      : fmt::format("{:.2f}, {:.3f}, {:.1f} %", of.psnr_db(),
                                                    of.ssim(), 100 * of.outliers());
        };
        return fmt::format("| {} | {} | {} |\n", name, cell(first), cell(later));
    }

    double loop_s_;
    Fidelities first_, later_;
    Fidelity first_sum_, later_sum_;
};

Move demo_move() { return Move::load(source_folder() / "hw_config/moves/demo.toml"); }

Played play(const PlayedTruth& wanted) {
    const DemoRigs rigs;
    StopSignal stop;  // after them: they would inherit what it holds back
    const StageConfig stage = load_stage_config(rigs.stage());
    FlightPlan plan;
    plan.move = demo_move();
    plan.seconds = wanted.seconds;
    StageReceiver receiver(stage);
    Played played;
    LiveSettings settings;
    settings.format = {.width_px = stage.view.width_px, .height_px = stage.view.height_px};
    settings.rate_hz = wanted.rate_hz;
    settings.pulse_rate_hz = stage.rate_hz;
    settings.quality = QualityRequest::parse(wanted.quality);
    LiveShow show(settings, plan, feed_of(receiver), nullptr);
    show.add(std::make_unique<KeepingSink>(played.shown));
    if (!show.wait_for_rigs(std::chrono::seconds(60), stop)) fail("interrupted");
    show.start();
    while (!show.is_over() && !stop.wait_for(std::chrono::milliseconds(20))) {
    }
    show.finish();
    played.report = show.report();
    return played;
}

ColourImage truth_of(VirtualStage& stage, const Shown& shown, TaiTime time) {
    const cv::Size size = shown.picture.size();
    return stage
        .render({size.width, size.height, shown.camera.K(size.width, size.height),
                 shown.camera.world_from_camera},
                time.time_since_epoch(), {.pictures = StagePictures::colour})
        .colour;
}

}  // namespace

std::string played_table(const PlayedTruth& wanted) {
    const Played played = play(wanted);
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    Fidelity instant, tick;
    Flicker flicker(noise_sigma);
    std::optional<std::size_t> before;  // the last new picture
    ColourImage truth_before;
    std::vector<cv::Mat> strip;
    const auto first = static_cast<std::size_t>(wanted.settling_s * wanted.rate_hz);
    constexpr std::size_t pictures_of_strip = 5;
    const std::size_t every = std::max<std::size_t>(
        1, (played.shown.size() - std::min(first, played.shown.size())) / pictures_of_strip);
    AlongMove along(demo_move().duration_s());
    for (std::size_t i = 0; i < played.shown.size(); ++i) {
        const Shown& shown = played.shown[i];
        const ColourImage truth = truth_of(stage, shown, shown.exposure);
        along.add(static_cast<double>(i) / wanted.rate_hz, shown.picture, truth);
        if (i < first) continue;
        instant.add(shown.picture, truth);
        tick.add(shown.picture, truth_of(stage, shown, shown.handed_over));
        if (const bool is_new = !before || shown.picture.data != played.shown[*before].picture.data;
            is_new) {
            if (before)
                flicker.add(played.shown[*before].picture, truth_before, shown.picture, truth,
                            cv::Mat1b(truth.size(), 255));
            before = i;
            truth_before = truth;
        }
        if (!wanted.strip.empty() && (i - first) % every == every / 2) {
            cv::Mat both;
            cv::vconcat(shown.picture, truth, both);
            strip.push_back(both);
        }
    }
    if (instant.pictures() == 0) fail("no picture came after the first {} s", wanted.settling_s);
    if (!strip.empty()) {
        cv::Mat all;
        cv::hconcat(strip, all);
        write_colour_image(wanted.strip, ColourImage(all));
    }
    const ProgrammeStats& stats = played.report.programme;
    return fmt::format(
        "The demo's rigs and a programme of {:g} frames per second, quality {}, on {}. There are "
        "{} "
        "pictures after the first {:g} s, repeated ones too.\n\n"
        "| against | PSNR dB | SSIM | outlier pixels |\n| --- | --- | --- | --- |\n"
        "| the instant shown | {:.2f} | {:.3f} | {:.1f} % |\n"
        "| the tick's own time | {:.2f} | {:.3f} | {:.1f} % |\n\n{}"
        "| | |\n| --- | --- |\n"
        "| flicker while the camera flies | {:.1f} times a camera's noise |\n"
        "| ticks: all, reprojected, repeated, missed | {}, {}, {}, {} |\n"
        "| reprojected by: p50, p99 | {:.1f}, {:.1f} % of the width |\n"
        "| hand-over after the tick: p50, p99, most | {:.1f}, {:.1f}, {:.0f} ms |\n"
        "| exposure to picture: p50, p95, p99 | {:.0f}, {:.0f}, {:.0f} ms |\n"
        "| between two new pictures: p50, p99 | {:.0f}, {:.0f} ms |\n"
        "| instants per second | {:.1f} |\n"
        "| levels by time: rendering | {} |\n"
        "| levels by time: preparing | {} |\n",
        wanted.rate_hz, wanted.quality, played.report.renderer, instant.pictures(),
        wanted.settling_s, instant.psnr_db(), instant.ssim(), 100 * instant.outliers(),
        tick.psnr_db(), tick.ssim(), 100 * tick.outliers(), along.table(),
        flicker.against_a_camera(), stats.ticks, stats.reprojected, stats.repeated, stats.missed,
        100 * stats.reprojected_way.p50, 100 * stats.reprojected_way.p99, stats.late_ms.p50,
        stats.late_ms.p99, stats.late_ms.max, stats.latency_ms.p50, stats.latency_ms.p95,
        stats.latency_ms.p99, stats.interval_ms.p50, stats.interval_ms.p99,
        static_cast<double>(played.report.instants_prepared) / stats.duration_s,
        shares_text(stats.render_shares), shares_text(stats.prepare_shares));
}

}  // namespace vantage
