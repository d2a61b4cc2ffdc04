#include "tests/bench/synthesis/stepped_truth.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/image/image_file.h"
#include "host_app/flight/moves/move.h"
#include "host_app/programme/view_painter.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/synthesis/fidelity.h"

namespace vantage {
namespace {

using std::chrono::nanoseconds;

nanoseconds nanoseconds_of(double s) { return nanoseconds(static_cast<std::int64_t>(s * 1e9)); }

/// What a real camera would see, and where performers are in its picture.
struct Truth {
    ColourImage colour;
    cv::Mat1b performers, edges, regions;
};

Truth true_picture(VirtualStage& stage, const StageCamera& camera, nanoseconds time,
                   const TruthRegions& regions) {
    const StageRendering seen = stage.render(camera, time);
    constexpr int band_px = 5;
    Truth truth{seen.colour, regions.performers(seen.depth_m), {}, regions.of(seen.depth_m)};
    truth.edges = band_of(truth.performers, band_px);
    return truth;
}

/// A camera that stands still on the stage.
class StillCamera {
  public:
    StillCamera(VirtualStage& stage, double azimuth_deg, cv::Size size) : stage_(&stage) {
        const StereoCalibration rig = rig_at(azimuth_deg, size);
        state_.world_from_camera = rig.world_from_left;
        state_.field_of_view_rad = 2 * std::atan(0.5 * size.width / rig.left.K()(0, 0));
        camera_ = {size.width, size.height, state_.K(size.width, size.height),
                   state_.world_from_camera};
        regions_.emplace(*stage_, camera_);
    }

    const CameraState& state() const { return state_; }

    Truth film(nanoseconds time) const { return true_picture(*stage_, camera_, time, *regions_); }

  private:
    VirtualStage* stage_;
    CameraState state_;
    StageCamera camera_;
    std::optional<TruthRegions> regions_;
};

/// The squared error of pictures, by region.
class RegionalError {
  public:
    void add(const ColourImage& picture, const Truth& truth) {
        cv::Mat off;
        cv::subtract(picture, truth.colour, off, cv::noArray(), CV_32F);
        off = off.mul(off);
        for (const TruthRegion region : all_truth_regions) {
            const cv::Mat1b where = truth.regions == static_cast<uchar>(region);
            const cv::Scalar sum = cv::mean(off, where) * cv::countNonZero(where);
            auto& [error, pixels] = regions_[region];
            error += sum[0] + sum[1] + sum[2];
            pixels += cv::countNonZero(where);
        }
    }
    /// Per cent of all pixels and of all squared error, each.
    std::string row() const {
        double errors = 0, all = 0;
        for (const auto& [region, sums] : regions_) errors += sums.first, all += sums.second;
        std::string text;
        for (const auto& [region, sums] : regions_)
            text += fmt::format(" {:.1f} / {:.1f} |", 100 * sums.second / all,
                                100 * sums.first / errors);
        return text;
    }

  private:
    std::map<TruthRegion, std::pair<double, double>> regions_;
};

/// One synthesiser, looked at from several cameras.
struct Measured {
    explicit Measured(double noise_sigma) : background(noise_sigma), performers(noise_sigma) {}

    Fidelity fidelity;
    RegionalError regions;
    Flicker background, performers;
    double edge_error = 0, set_psnr_db = 0, foreground_psnr_db = 0;
    ImmersiveMetrics whole, foreground;  ///< sums
    int edge_pictures = 0;
    std::vector<double> take_ms, prepare_ms, render_ms;
    std::map<std::size_t, std::pair<ColourImage, Truth>> before;  ///< by camera
};

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

void add(ImmersiveMetrics& sum, const ImmersiveMetrics& one) {
    sum.iv_psnr_db += one.iv_psnr_db;
    sum.iv_ssim += one.iv_ssim;
}

void write_beside(const std::string& folder, const std::string& name, const ColourImage& picture,
                  const ColourImage& truth) {
    std::filesystem::create_directories(folder);
    cv::Mat both;
    cv::hconcat(picture, truth, both);
    write_colour_image(std::filesystem::path(folder) / (name + ".png"), ColourImage(both));
}

/// What is learnt of the background while performers walk a whole loop of the stage.
Background set_of_a_loop(const SynthesiserEntry& synthesiser, const ShaderLibrary& library,
                         VirtualStage& stage, std::span<const std::unique_ptr<MatchingRig>> rigs,
                         bool with_own_depth) {
    constexpr std::chrono::milliseconds loop{24000}, step{800};
    // Told to be closer in time than they are, so that they make one mean.
    constexpr double told_dt_s = 0.2;
    const std::unique_ptr<InstantPreparer> preparer = synthesiser.make_preparer(library);
    if (!preparer->background_access())
        fail("the synthesiser {} learns no background", synthesiser.name);
    std::uint64_t instant = 1'000'000;  // noise of its own
    for (std::chrono::milliseconds time{0}; time < loop; time += step) {
        std::vector<DepthView> views;
        for (const auto& rig : rigs) {
            rig->film(stage, time, instant);
            views.push_back(rig->view(with_own_depth));
        }
        preparer->take(views, told_dt_s);
        ++instant;
    }
    return preparer->background_access()->learnt();
}

std::vector<std::unique_ptr<MatchingRig>> rigs_of(const ShaderLibrary& library,
                                                  const SteppedTruth& wanted) {
    std::vector<std::unique_ptr<MatchingRig>> rigs;
    for (const double place : {-1.5, -0.5, 0.5, 1.5})
        rigs.push_back(std::make_unique<MatchingRig>(library, place * wanted.apart_deg,
                                                     rigs.size() + 1, wanted.rigs));
    return rigs;
}

/// All rigs' views of a moment, with the stage's own depth where it is wanted.
class Filming {
  public:
    Filming(std::span<const std::unique_ptr<MatchingRig>> rigs, const SteppedTruth& wanted,
            VirtualStage& truth_stage)
        : rigs_(rigs), has_own_depth_(!wanted.with_exact_depth), exact_in_(wanted.exact_in) {
        if (exact_in_.empty()) return;
        for (const auto& rig : rigs) regions_.emplace_back(truth_stage, rig->camera());
    }

    std::vector<DepthView> film(VirtualStage& stage, nanoseconds time, std::uint64_t k) const {
        std::vector<DepthView> views;
        for (std::size_t i = 0; i < rigs_.size(); ++i) {
            rigs_[i]->film(stage, time, k);
            views.push_back(rigs_[i]->view(has_own_depth_));
            if (exact_in_.empty()) continue;
            DepthImage depth_m = views.back().depth_m.clone();
            DepthImage exact_m = rigs_[i]->view(false).depth_m;
            cv::Mat1b regions = regions_[i].of(exact_m);
            cv::resize(regions, regions, depth_m.size(), 0, 0, cv::INTER_NEAREST);
            cv::resize(exact_m, exact_m, depth_m.size(), 0, 0, cv::INTER_NEAREST);
            for (const TruthRegion region : exact_in_)
                exact_m.copyTo(depth_m, regions == static_cast<uchar>(region));
            views.back().depth_m = depth_m;
        }
        return views;
    }

  private:
    std::span<const std::unique_ptr<MatchingRig>> rigs_;
    bool has_own_depth_;
    std::vector<TruthRegion> exact_in_;
    std::vector<TruthRegions> regions_;
};

std::string rows(const ShaderLibrary& library, const SteppedTruth& wanted, std::uint64_t scene) {
    VirtualStage stage(library, scene), truth_stage(library, scene);
    const std::vector<std::unique_ptr<MatchingRig>> rigs = rigs_of(library, wanted);
    const Filming filming(rigs, wanted, truth_stage);
    std::vector<StillCamera> cameras;
    for (const double place : wanted.cameras)
        cameras.emplace_back(truth_stage, place * wanted.apart_deg, wanted.rigs.size);

    const PictureFormat format{.width_px = wanted.rigs.size.width,
                               .height_px = wanted.rigs.size.height};
    const PrepareLevel& prepare_level =
        prepare_levels()[static_cast<std::size_t>(wanted.prepare_level)];
    const RenderLevel& render_level =
        render_levels()[static_cast<std::size_t>(wanted.render_level)];
    struct Runner {
        std::unique_ptr<InstantPreparer> preparer;
        std::unique_ptr<ViewPainter> painter;
        Measured measured;
    };
    std::vector<Runner> runners;
    for (const std::string& name : wanted.synthesisers) {
        const SynthesiserEntry entry = find_synthesiser(name);
        runners.push_back({entry.make_preparer(library),
                           std::make_unique<ViewPainter>(entry, format, library),
                           Measured(wanted.rigs.noise_sigma)});
    }

    if (wanted.knows_background) {
        const auto learnt = std::make_shared<const Background>(
            set_of_a_loop(find_synthesiser(wanted.synthesisers.front()), library, stage, rigs,
                          !wanted.with_exact_depth));
        for (Runner& runner : runners)
            if (BackgroundAccess* memory = runner.preparer->background_access())
                memory->begin_with(learnt);
    }

    const auto instants = static_cast<std::uint64_t>(
        std::llround((wanted.settling_s + wanted.measured_s) * wanted.rate_hz));
    const auto settled =
        static_cast<std::uint64_t>(std::llround(wanted.settling_s * wanted.rate_hz));
    for (std::uint64_t k = 0; k < instants; ++k) {
        const nanoseconds time =
            nanoseconds_of(wanted.start_s + static_cast<double>(k) / wanted.rate_hz);
        const std::vector<DepthView> views = filming.film(stage, time, k);
        std::vector<Truth> truths;
        if (k >= settled)
            for (const StillCamera& camera : cameras) truths.push_back(camera.film(time));
        for (std::size_t r = 0; r < runners.size(); ++r) {
            Runner& runner = runners[r];
            Measured& measured = runner.measured;
            double before_ms = cpu_ms();
            runner.preparer->take(views, 1 / wanted.rate_hz);
            glFinish();
            measured.take_ms.push_back(cpu_ms() - before_ms);
            runner.preparer->improve(
                view_of(cameras[0].state(), {format.width_px, format.height_px}));
            for (std::size_t c = 0; c < cameras.size(); ++c) {
                const VirtualView target =
                    view_of(cameras[c].state(), {format.width_px, format.height_px});
                before_ms = cpu_ms();
                const auto instant = runner.preparer->prepare(target, prepare_level);
                glFinish();
                if (c == 0) measured.prepare_ms.push_back(cpu_ms() - before_ms);
                if (k < settled) break;
                before_ms = cpu_ms();
                const ColourImage picture =
                    runner.painter->paint(*instant, cameras[c].state(), render_level);
                measured.render_ms.push_back(cpu_ms() - before_ms);
                const Truth& truth = truths[c];
                measured.fidelity.add(picture, truth.colour);
                measured.regions.add(picture, truth);
                add(measured.whole, immersive_metrics(picture, truth.colour));
                if (cv::countNonZero(truth.edges) > 0) {
                    measured.set_psnr_db += psnr_db(picture, truth.colour, ~truth.performers);
                    measured.foreground_psnr_db += psnr_db(picture, truth.colour, truth.performers);
                    measured.edge_error += mean_error(picture, truth.colour, truth.edges);
                    add(measured.foreground,
                        immersive_metrics(picture, truth.colour, truth.performers));
                    ++measured.edge_pictures;
                }
                if (const auto found = measured.before.find(c); found != measured.before.end()) {
                    const auto& [picture_before, truth_before] = found->second;
                    const cv::Mat1b moving = truth.performers | truth_before.performers;
                    const cv::Mat1b still = ~moving;
                    measured.background.add(picture_before, truth_before.colour, picture,
                                            truth.colour, still);
                    measured.performers.add(picture_before, truth_before.colour, picture,
                                            truth.colour, moving);
                }
                measured.before[c] = {picture, truth};
                if (k + 1 == instants && !wanted.pictures.empty())
                    write_beside(wanted.pictures,
                                 fmt::format("{}_scene{}_{}", wanted.synthesisers[r], scene, c),
                                 picture, truth.colour);
            }
        }
    }
    std::string text;
    for (std::size_t r = 0; r < runners.size(); ++r) {
        const Measured& m = runners[r].measured;
        text += fmt::format(
            "| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.3f} | {:.1f} % | {:.1f} | {:.2f} | {:.2f} | "
            "{:.2f} / {:.3f} | {:.2f} / {:.3f} |",
            wanted.synthesisers[r], scene, m.fidelity.psnr_db(),
            m.set_psnr_db / std::max(m.edge_pictures, 1),
            m.foreground_psnr_db / std::max(m.edge_pictures, 1), m.fidelity.ssim(),
            100 * m.fidelity.outliers(), m.edge_error / std::max(m.edge_pictures, 1),
            m.background.against_a_camera(), m.performers.against_a_camera(),
            m.whole.iv_psnr_db / m.fidelity.pictures(), m.whole.iv_ssim / m.fidelity.pictures(),
            m.foreground.iv_psnr_db / std::max(m.edge_pictures, 1),
            m.foreground.iv_ssim / std::max(m.edge_pictures, 1));
        if (wanted.with_times)
            text += fmt::format(" {:.0f} | {:.0f} | {:.0f} |", median(m.take_ms),
                                median(m.prepare_ms), median(m.render_ms));
        if (wanted.with_regions) text += m.regions.row();
        text += "\n";
    }
    return text;
}

/// The rows of one scene for a camera that flies a move.
std::string flown_rows(const ShaderLibrary& library, const SteppedTruth& wanted,
                       std::uint64_t scene) {
    VirtualStage stage(library, scene), truth_stage(library, scene);
    const std::vector<std::unique_ptr<MatchingRig>> rigs = rigs_of(library, wanted);
    const Filming filming(rigs, wanted, truth_stage);
    const Move move = Move::load(wanted.flight);
    const cv::Size size = wanted.flown_size;
    std::string text;
    for (const std::string& name : wanted.synthesisers) {
        const SynthesiserEntry entry = find_synthesiser(name);
        const std::unique_ptr<InstantPreparer> preparer = entry.make_preparer(library);
        ViewPainter painter(entry, {.width_px = size.width, .height_px = size.height}, library);
        Fidelity fidelity;
        RegionalError regional;
        const double rate_hz = wanted.rate_hz;
        const auto instants = std::llround((wanted.settling_s + wanted.measured_s) * rate_hz);
        for (std::int64_t k = 0; k < instants; ++k) {
            const double time_s = static_cast<double>(k) / rate_hz;
            const nanoseconds time = nanoseconds_of(wanted.start_s + time_s);
            const std::vector<DepthView> views =
                filming.film(stage, time, static_cast<std::uint64_t>(k));
            const CameraState camera = move.at(time_s).camera();
            const VirtualView target = view_of(camera, size);
            preparer->take(views, 1 / rate_hz);
            preparer->improve(target);
            const auto instant = preparer->prepare(
                target, prepare_levels()[static_cast<std::size_t>(wanted.prepare_level)]);
            if (time_s < wanted.settling_s) continue;
            const ColourImage picture = painter.paint(
                *instant, camera, render_levels()[static_cast<std::size_t>(wanted.render_level)]);
            const StageCamera place{size.width, size.height, camera.K(size.width, size.height),
                                    camera.world_from_camera};
            ColourImage truth;
            if (wanted.with_regions) {
                const Truth seen =
                    true_picture(truth_stage, place, time, TruthRegions(truth_stage, place));
                regional.add(picture, seen);
                truth = seen.colour;
            } else {
                truth = truth_stage.render(place, time, {.pictures = StagePictures::colour}).colour;
            }
            fidelity.add(picture, truth);
            if (!wanted.pictures.empty())
                write_beside(wanted.pictures, fmt::format("{}_scene{}_{:03}", name, scene, k),
                             picture, truth);
        }
        text += fmt::format("| {} | {} | {:.2f} | {:.3f} | {:.1f} % |", name, scene,
                            fidelity.psnr_db(), fidelity.ssim(), 100 * fidelity.outliers());
        if (wanted.with_regions) text += regional.row();
        text += "\n";
    }
    return text;
}

/// The columns of RegionalError::row().
std::string region_names(const SteppedTruth& wanted) {
    std::string names;
    if (wanted.with_regions)
        for (const TruthRegion region : all_truth_regions)
            names += fmt::format(" {} |", words_of(region));
    return names;
}

std::string region_rules(const SteppedTruth& wanted) {
    std::string rules;
    if (wanted.with_regions)
        for (std::size_t i = 0; i < all_truth_regions.size(); ++i) rules += " --- |";
    return rules;
}

std::string flown_table(const ShaderLibrary& library, const SteppedTruth& wanted) {
    std::string text = fmt::format(
        "Four rigs of {}x{}, {:g} degrees apart, {} depth. {:g} instants a second, prepared at "
        "level {} and rendered at level {}; a camera of {}x{} that flies a move, from {:g} s on "
        "and for {:g} s.\n\n| synthesiser | scene | PSNR dB | SSIM | outlier pixels |{}\n"
        "| --- | --- | --- | --- | --- |{}\n",
        wanted.rigs.size.width, wanted.rigs.size.height, wanted.apart_deg,
        wanted.with_exact_depth ? "exact" : "own", wanted.rate_hz, wanted.prepare_level,
        wanted.render_level, wanted.flown_size.width, wanted.flown_size.height, wanted.settling_s,
        wanted.measured_s, region_names(wanted), region_rules(wanted));
    for (const std::uint64_t scene : wanted.scenes) text += flown_rows(library, wanted, scene);
    return text;
}

}  // namespace

std::string stepped_table(const ShaderLibrary& library, const SteppedTruth& wanted) {
    if (!wanted.flight.empty()) return flown_table(library, wanted);
    std::string text = fmt::format(
        "Four rigs of {}x{}, {:g} degrees apart, sensor noise of {:g} grey level, {} depth{}. {:g} "
        "instants a second, prepared at level {} and rendered at level {}; cameras {} distances "
        "between rigs from the middle, {:g} s after the start and {:g} s long.{}\n\n"
        "| synthesiser | scene | PSNR dB | of the background | of performers | SSIM | outlier "
        "pixels | performers' "
        "edges: mean error | flicker: background | performers | IV-PSNR dB / IV-SSIM | of "
        "performers |{}{}\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |{}{}\n",
        wanted.rigs.size.width, wanted.rigs.size.height, wanted.apart_deg, wanted.rigs.noise_sigma,
        wanted.with_exact_depth ? "exact" : "own",
        wanted.knows_background ? ", a background learnt before" : "", wanted.rate_hz,
        wanted.prepare_level, wanted.render_level, fmt::join(wanted.cameras, ", "),
        wanted.settling_s, wanted.measured_s,
        wanted.with_times ? " Times are of the processor, milliseconds an instant or picture." : "",
        wanted.with_times ? " take | prepare | render |" : "", region_names(wanted),
        wanted.with_times ? " --- | --- | --- |" : "", region_rules(wanted));
    for (const std::uint64_t scene : wanted.scenes) text += rows(library, wanted, scene);
    return text;
}

}  // namespace vantage
