#include <array>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/time/time.h"
#include "common/config/gpu_frame_model.h"
#include "common/config/stage_config.h"
#include "common/receive/link_budget.h"
#include "common/receive/stage_receiver.h"
#include "common/wire/codec/colour_codec.h"
#include "common/wire/frame_codec.h"
#include "host_app/commands/rigs/rigs_commands.h"
#include "host_app/pipeline/rig_demand.h"
#include "host_app/session/options/common_options.h"

namespace vantage {
namespace {

struct PlanOptions {
    std::string stage;
    double seconds = 3, wait_s = 10, rate_hz = 0;
    LinkLimits limits{.programme_rigs = RigDemand::most_rigs};
    bool start = false, json = false;
};

/// JPEG qualities that are tried if the stage does not fit the network.
constexpr int ladder[] = {90, 85, 80, 75, 70, 65, 60, 50, 40};
/// Scales of width and height that are tried, at a usual quality.
constexpr double smaller_by[] = {0.75, 0.5};
constexpr int usual_quality = 85;

/// Sums the sizes of the received frames by rig. From any thread.
class Scales {
  public:
    explicit Scales(const StageConfig& stage) {
        for (const StageConfig::Rig& rig : stage.rigs) weights_.push_back({.rig = rig.name});
    }
    void see(const ArrivedFrame& frame) {
        const std::lock_guard lock(mutex_);
        RigWeight& weight = weights_[frame.rig];
        ++weight.frames;
        weight.colour_bytes += static_cast<double>(frame.packed->colour.size());
        weight.other_bytes +=
            static_cast<double>(frame.packed->bytes() - frame.packed->colour.size());
    }
    /// Returns the rigs without a frame.
    std::vector<std::string> silent() const {
        const std::lock_guard lock(mutex_);
        std::vector<std::string> silent;
        for (const RigWeight& weight : weights_)
            if (weight.frames == 0) silent.push_back(weight.rig);
        return silent;
    }
    std::vector<RigWeight> means() const {
        const std::lock_guard lock(mutex_);
        std::vector<RigWeight> means = weights_;
        for (RigWeight& weight : means) {
            weight.colour_bytes /= std::max(1, weight.frames);
            weight.other_bytes /= std::max(1, weight.frames);
        }
        return means;
    }

  private:
    mutable std::mutex mutex_;
    std::vector<RigWeight> weights_;
};

/// Encodes a rig's latest picture at every quality and size, with the rig's own chroma subsampling;
/// for a lossless rig with the default subsampling.
void weigh(const RigFrame& frame, RigWeight& weight) {
    const bool is_jpeg = decode_frame_head(frame.packed->header).colour == FrameHead::Colour::jpeg;
    const Chroma chroma = is_jpeg ? JpegDecoder().chroma_of(frame.packed->colour) : Chroma::quarter;
    JpegEncoder encoder;
    for (const int quality : ladder)
        weight.ladder.push_back(
            {quality, static_cast<double>(encoder.encode(frame.colour, quality, chroma).size())});
    const auto whole = encoder.encode(frame.colour, usual_quality, chroma).size();
    for (const double scale : smaller_by) {
        cv::Mat smaller;
        cv::resize(frame.colour, smaller, {}, scale, scale, cv::INTER_AREA);
        const auto bytes = encoder.encode(smaller, usual_quality, chroma).size();
        weight.smaller.push_back({scale, static_cast<double>(bytes) / static_cast<double>(whole)});
    }
}

/// The time that a rig's GPU takes for a frame, by the rig's own measurement.
class GpuTimes {
  public:
    void add(const RigStageTimes& times) {
        sum_ms_ += times.rectify_ms + times.match_ms;
        ++frames_;
    }
    /// Nothing from a rig that neither rectifies nor matches, whose time is that of a few calls.
    std::optional<double> mean_ms() const {
        constexpr double least_ms = 0.1;
        if (frames_ == 0 || sum_ms_ / frames_ < least_ms) return {};
        return sum_ms_ / frames_;
    }

  private:
    double sum_ms_ = 0;
    int frames_ = 0;
};

struct Measured {
    std::vector<RigWeight> weights;
    std::vector<std::shared_ptr<const RigFrame>> latest;  ///< of each; null: it has no colour
    std::vector<GpuTimes> gpu_times;
};

Measured measure(const PlanOptions& options, const StageConfig& stage) {
    StopSignal stop;
    Scales scales(stage);
    StageReceiver receiver(
        stage, options.start ? StageReceiver::Purpose::film : StageReceiver::Purpose::observe,
        [&](const ArrivedFrame& frame) { scales.see(frame); });
    for (const StageConfig::Rig& rig : stage.rigs) receiver.ask(rig.name, true, 1);
    std::vector<std::shared_ptr<const RigFrame>> latest(stage.rigs.size());
    std::vector<GpuTimes> gpu_times(stage.rigs.size());
    const MonotonicTime give_up = MonotonicClock::now() + from_s(options.wait_s);
    std::optional<MonotonicTime> end;
    while (!stop.requested()) {
        const MonotonicTime now = MonotonicClock::now();
        if (end ? now >= *end : now >= give_up) break;
        const std::optional<FrameSet> set = receiver.next(std::chrono::milliseconds(100));
        if (!set) continue;
        // The measurement starts when every rig has sent a frame.
        if (!end && scales.silent().empty()) end = MonotonicClock::now() + from_s(options.seconds);
        for (std::size_t i = 0; i < set->slots.size(); ++i) {
            const auto& frame = set->slots[i].frame;
            if (!frame) continue;
            gpu_times[i].add(frame->times);
            if (!frame->colour.empty()) latest[i] = frame;
        }
    }
    if (const std::vector<std::string> silent = scales.silent(); !silent.empty())
        fail("{} sent no frames{}; vantage rigs status shows why", fmt::join(silent, ", "),
             options.start ? ""
                           : "; rigs capture only while a host runs the stage, or with --start");
    std::vector<RigWeight> weights = scales.means();
    const ReceiverStatus status = receiver.status();
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i].by_datagrams = status.rigs[i].by_datagrams;
    return {std::move(weights), std::move(latest), std::move(gpu_times)};
}

std::string words_of(const LinkBudget::Proposal& proposal, double rate_hz) {
    constexpr double percent = 100;
    if (proposal.scale < 1)
        return fmt::format("pictures of {:.0f} % of the width and the height",
                           percent * proposal.scale);
    if (proposal.rigs > 0)
        return fmt::format("{} rigs at a time, as a programme requests without a take",
                           proposal.rigs);
    std::string text;
    if (proposal.jpeg_quality) text = fmt::format("jpeg_quality = {}", *proposal.jpeg_quality);
    if (proposal.rate_divisor > 1)
        text +=
            fmt::format("{}{:.4g} frames per second, every {}{} pulse", text.empty() ? "" : " and ",
                        rate_hz / proposal.rate_divisor, proposal.rate_divisor,
                        proposal.rate_divisor == 2   ? "nd"
                        : proposal.rate_divisor == 3 ? "rd"
                                                     : "th");
    return text;
}

void print(const std::vector<RigWeight>& weights, const LinkBudget& budget, double rate_hz) {
    constexpr double bytes_a_kb = 1e3, percent = 100;
    std::size_t width = 4;
    for (const RigWeight& weight : weights) width = std::max(width, weight.rig.size());
    std::cout << fmt::format("{:{}}  {:>9}  {:>8}  {:>8}  {:>22}\n", "", width, "colour kB",
                             "other kB", "Mbit/s", "of the planned share");
    for (std::size_t i = 0; i < weights.size(); ++i)
        std::cout << fmt::format("{:{}}  {:9.1f}  {:8.1f}  {:8.1f}  {:20.0f} %\n", weights[i].rig,
                                 width, weights[i].colour_bytes / bytes_a_kb,
                                 weights[i].other_bytes / bytes_a_kb, budget.rigs[i].mbit_s,
                                 percent * budget.rigs[i].share);
    std::cout << fmt::format("{:{}}  {:9}  {:8}  {:8.1f}  {:20.0f} %\n", "host", width, "", "",
                             budget.host_mbit_s, percent * budget.host_share);
    if (budget.fits()) return;
    for (const LinkBudget::Proposal& proposal : budget.proposals)
        std::cout << fmt::format("proposal: {}: {:.0f} Mbit/s at the host\n",
                                 words_of(proposal, rate_hz), proposal.host_mbit_s);
}

/// Returns the different kinds of frames that the rigs match.
std::vector<MatchedFrame> matched_frames(const std::vector<std::shared_ptr<const RigFrame>>& latest,
                                         double rate_hz) {
    std::set<std::array<int, 5>> shapes;
    for (const auto& frame : latest) {
        if (!frame || frame->max_disparity_px <= 0) continue;
        const cv::Size colour(frame->geometry.width_px, frame->geometry.height_px);
        const cv::Size matched = frame->disparity.empty() ? colour : frame->disparity.size();
        const cv::Size reduced = matched == colour ? cv::Size() : colour;
        shapes.insert({matched.width, matched.height, static_cast<int>(frame->max_disparity_px),
                       reduced.width, reduced.height});
    }
    std::vector<MatchedFrame> frames;
    for (const auto& [width_px, height_px, disparities, colour_width_px, colour_height_px] : shapes)
        frames.push_back(
            {width_px, height_px, disparities, rate_hz, colour_width_px, colour_height_px});
    return frames;
}

/// Which preset a Raspberry Pi could match the rigs' pictures with.
void print_gpu_fits(const std::vector<MatchedFrame>& frames) {
    for (const MatchedFrame& frame : frames)
        for (const GpuFrameModel& model : GpuFrameModel::all())
            std::cout << model.fit_text(frame) << "\n";
}

/// Prints the time that each rig's GPU takes for a frame, and the limit that holds the rate.
void print_gpu_times(const StageConfig& stage, const std::vector<GpuTimes>& times, double rate_hz) {
    const double limit_ms = GpuFrameModel::limit_ms(rate_hz);
    for (std::size_t i = 0; i < times.size(); ++i)
        if (const auto ms = times[i].mean_ms())
            std::cout << fmt::format(
                "{}: its GPU takes {:.1f} ms per frame, {} two thirds of a period at {:.4g} Hz "
                "({:.1f} ms)\n",
                stage.rigs[i].name, *ms, *ms <= limit_ms ? "within" : "more than", rate_hz,
                limit_ms);
}

nlohmann::ordered_json gpu_fits_as_json(const std::vector<MatchedFrame>& frames) {
    auto fits = nlohmann::ordered_json::array();
    for (const MatchedFrame& frame : frames)
        for (const GpuFrameModel& model : GpuFrameModel::all())
            fits.push_back(model.fit_json(frame));
    return fits;
}

nlohmann::ordered_json to_json(const std::vector<RigWeight>& weights, const LinkBudget& budget,
                               double rate_hz) {
    nlohmann::ordered_json rigs = nlohmann::ordered_json::array(), proposals = rigs;
    for (std::size_t i = 0; i < weights.size(); ++i)
        rigs.push_back({{"name", weights[i].rig},
                        {"frames", weights[i].frames},
                        {"colour_bytes", weights[i].colour_bytes},
                        {"other_bytes", weights[i].other_bytes},
                        {"road", weights[i].by_datagrams ? "srt" : "tcp"},
                        {"mbit_s", budget.rigs[i].mbit_s},
                        {"share", budget.rigs[i].share}});
    for (const LinkBudget::Proposal& proposal : budget.proposals) {
        nlohmann::ordered_json json{{"rate_divisor", proposal.rate_divisor},
                                    {"host_mbit_s", proposal.host_mbit_s}};
        if (proposal.jpeg_quality) json["jpeg_quality"] = *proposal.jpeg_quality;
        if (proposal.scale < 1) json["scale"] = proposal.scale;
        if (proposal.rigs > 0) json["rigs"] = proposal.rigs;
        proposals.push_back(std::move(json));
    }
    return {{"rate_hz", rate_hz},
            {"rigs", rigs},
            {"host", {{"mbit_s", budget.host_mbit_s}, {"share", budget.host_share}}},
            {"fits", budget.fits()},
            {"proposals", proposals}};
}

void plan(const PlanOptions& options) {
    const StageConfig stage = load_stage_config(options.stage);
    auto [weights, latest, gpu_times] = measure(options, stage);
    const double rate_hz = options.rate_hz > 0 ? options.rate_hz : stage.rate_hz;
    LinkBudget budget = plan_links(weights, rate_hz, options.limits);
    if (!budget.fits()) {
        for (std::size_t i = 0; i < weights.size(); ++i)
            if (latest[i]) weigh(*latest[i], weights[i]);
        budget = plan_links(weights, rate_hz, options.limits);
    }
    const std::vector<MatchedFrame> frames = matched_frames(latest, rate_hz);
    if (options.json) {
        nlohmann::ordered_json json = to_json(weights, budget, rate_hz);
        for (std::size_t i = 0; i < gpu_times.size(); ++i)
            if (const auto ms = gpu_times[i].mean_ms()) json["rigs"][i]["gpu_ms"] = *ms;
        json["gpu_fits"] = gpu_fits_as_json(frames);
        std::cout << json.dump() << '\n';
    } else {
        print(weights, budget, rate_hz);
        print_gpu_times(stage, gpu_times, rate_hz);
        print_gpu_fits(frames);
    }
    if (budget.fits()) return;
    std::string full;
    for (const LinkBudget::Rig& rig : budget.rigs)
        if (rig.share > 1)
            full +=
                fmt::format("{}{} needs {:.0f} Mbit/s of a link of {:g}", full.empty() ? "" : "; ",
                            rig.rig, rig.mbit_s, options.limits.rig_mbit_s);
    if (budget.host_share > 1)
        full +=
            fmt::format("{}the host needs {:.0f} Mbit/s of a link of {:g}",
                        full.empty() ? "" : "; ", budget.host_mbit_s, options.limits.host_mbit_s);
    fail("{}, of which 80 % may be used", full);
}

}  // namespace

void add_rigs_plan(CLI::App& rigs) {
    auto options = std::make_shared<PlanOptions>();
    CLI::App* plans = rigs.add_subcommand(
        "plan",
        "Measure what every rig sends and check whether the network carries it; exit with 1 and "
        "proposals if not");
    plans->add_option("--stage", options->stage, stage_file_help)->required();
    plans
        ->add_option("--rig-link", options->limits.rig_mbit_s,
                     "Set the speed of each rig's network interface in Mbit/s")
        ->check(CLI::Range(1.0, 1e6))
        ->capture_default_str();
    plans
        ->add_option("--host-link", options->limits.host_mbit_s,
                     "Set the speed of the host's network interface in Mbit/s")
        ->check(CLI::Range(1.0, 1e6))
        ->capture_default_str();
    plans->add_option("--rate", options->rate_hz, "Plan for this frame rate (default: the stage's)")
        ->check(CLI::Range(0.01, 1000.0));
    plans->add_option("--seconds", options->seconds, "Measure for this many seconds")
        ->check(CLI::Range(0.1, 3600.0))
        ->capture_default_str();
    plans
        ->add_option("--wait", options->wait_s,
                     "Wait at most this many seconds for the first frames")
        ->check(CLI::Range(0.1, 3600.0))
        ->capture_default_str();
    plans->add_flag("--start", options->start,
                    "Start the stage's pulses; use it only if no other host runs the stage");
    plans->add_flag("--json", options->json, "Print the result as JSON");
    plans->callback([options] { plan(*options); });
}

}  // namespace vantage
