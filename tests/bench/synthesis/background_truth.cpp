#include "tests/bench/synthesis/background_truth.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "common/image/image_file.h"
#include "host_app/fused/staged_preparer.h"
#include "tests/bench/synthesis/truth_regions.h"

namespace vantage {
namespace {

constexpr std::array background_regions{TruthRegion::surfaces, TruthRegion::rims,
                                        TruthRegion::thin};

/// Errors of depth as parallax in the picture of the next rig.
class DepthErrors {
  public:
    /// `parallax_px`: of an inverse depth of 1/m.
    void add(const DepthImage& depth_m, const DepthImage& truth_m, const cv::Mat1b& regions,
             const cv::Mat1b& known, double parallax_px) {
        for (int y = 0; y < truth_m.rows; ++y)
            for (int x = 0; x < truth_m.cols; ++x) {
                ++pixels_;
                if (!known(y, x)) continue;
                ++known_;
                const float z = std::abs(depth_m(y, x));
                const double off_px =
                    z > 0 ? parallax_px * std::abs(1 / z - 1 / truth_m(y, x)) : 1000;
                errors_[static_cast<TruthRegion>(regions(y, x))].push_back(off_px);
            }
    }
    std::string row() {
        std::string text = fmt::format(" {:.1f} |", 100.0 * known_ / pixels_);
        for (const TruthRegion region : background_regions) {
            std::vector<double>& errors = errors_[region];
            std::sort(errors.begin(), errors.end());
            const auto beyond = [&](double px) {
                return 100.0 *
                       static_cast<double>(errors.end() -
                                           std::upper_bound(errors.begin(), errors.end(), px)) /
                       static_cast<double>(errors.size());
            };
            text += fmt::format(" {:.2f} | {:.1f} | {:.1f} | {:.1f} |", errors[errors.size() / 2],
                                beyond(1), beyond(3), beyond(10));
        }
        return text;
    }

  private:
    std::map<TruthRegion, std::vector<double>> errors_;
    int pixels_ = 0, known_ = 0;
};

void write_error(const std::string& folder, const std::string& name, const ColourImage& colour,
                 const DepthImage& before_m, const DepthImage& depth_m, const DepthImage& truth_m,
                 double parallax_px) {
    std::filesystem::create_directories(folder);
    const auto error = [&](const DepthImage& map_m) {
        ColourImage picture(truth_m.size());
        for (int y = 0; y < truth_m.rows; ++y)
            for (int x = 0; x < truth_m.cols; ++x) {
                const float z = std::abs(map_m(y, x));
                const double off = z > 0 ? parallax_px * (1 / z - 1 / truth_m(y, x)) : 0;
                // Red: nearer than it is, blue: farther; whole from 8 px on.
                const auto level = cv::saturate_cast<uchar>(255 * std::sqrt(std::abs(off) / 8));
                picture(y, x) = z == 0    ? cv::Vec4b(255, 255, 0, 255)
                                : off > 0 ? cv::Vec4b(level, 0, 0, 255)
                                          : cv::Vec4b(0, level / 2, level, 255);
            }
        return picture;
    };
    cv::Mat all;
    cv::hconcat(std::vector<cv::Mat>{colour, error(before_m), error(depth_m)}, all);
    write_colour_image(std::filesystem::path(folder) / (name + ".png"), ColourImage(all));
}

std::string rows(const ShaderLibrary& library, const BackgroundTruth& wanted, std::uint64_t scene) {
    VirtualStage stage(library, scene);
    std::vector<std::unique_ptr<MatchingRig>> rigs;
    std::vector<TruthRegions> regions;
    for (const double place : {-1.5, -0.5, 0.5, 1.5}) {
        rigs.push_back(std::make_unique<MatchingRig>(library, place * wanted.apart_deg,
                                                     rigs.size() + 1, wanted.rigs));
        regions.emplace_back(stage, rigs.back()->camera());
    }
    StagedPreparer preparer(library);
    const auto instants = static_cast<std::uint64_t>(std::llround(wanted.seconds * wanted.rate_hz));
    for (std::uint64_t k = 0; k < instants; ++k) {
        const std::chrono::nanoseconds time(
            std::llround(1e9 * (wanted.start_s + static_cast<double>(k) / wanted.rate_hz)));
        std::vector<DepthView> views;
        for (const auto& rig : rigs) {
            rig->film(stage, time, k);
            views.push_back(rig->view(true));
        }
        preparer.take(views, 1 / wanted.rate_hz);
        const VirtualView target = camera_of(rig_at(0, wanted.rigs.size));
        preparer.improve(target);
        (void)preparer.prepare(target, prepare_levels().front());
    }
    const Background learnt = preparer.background_access()->learnt();
    DepthErrors learnt_errors, refined_errors;
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        const StageCamera camera = rigs[i]->camera();
        const VirtualView target{camera.width_px, camera.height_px, camera.K,
                                 camera.world_from_camera};
        const std::shared_ptr<const Instant> instant =
            preparer.prepare(target, prepare_levels().front());
        const RigSurface& surface = *instant->rigs.at(0).surface;
        const DepthImage depth_m(surface.depth().download());
        const DepthImage& truth_m = regions[i].background_depth_m();
        const double apart_m = (camera.world_from_camera.translation() -
                                rigs[i > 0 ? i - 1 : 1]->camera().world_from_camera.translation())
                                   .norm();
        const double parallax_px = camera.K(0, 0) * apart_m;
        const cv::Mat1b where = regions[i].of(truth_m);
        const cv::Mat1b is_known =
            BackgroundModel::known(learnt.rigs[i], 1 / wanted.rate_hz) & (depth_m > 0);
        learnt_errors.add(learnt.rigs[i].depth_m, truth_m, where, is_known, parallax_px);
        refined_errors.add(depth_m, truth_m, where, is_known, parallax_px);
        if (!wanted.pictures.empty())
            write_error(wanted.pictures, fmt::format("scene{}_rig{}", scene, i),
                        learnt.rigs[i].colour, learnt.rigs[i].depth_m, depth_m, truth_m,
                        parallax_px);
    }
    return fmt::format("| {} | learnt |{}\n| {} | refined |{}\n", scene, learnt_errors.row(), scene,
                       refined_errors.row());
}

}  // namespace

std::string background_table(const ShaderLibrary& library, const BackgroundTruth& wanted) {
    std::string head = "| scene | depth | known |", rule = "| --- | --- | --- |";
    for (const TruthRegion region : background_regions) {
        head += fmt::format(" {}: median px | > 1 px | > 3 px | > 10 px |", words_of(region));
        rule += " --- | --- | --- | --- |";
    }
    std::string text = fmt::format(
        "Four rigs of {}x{}, {:g} degrees apart, sensor noise of {:g} grey level, after {:g} s at "
        "{:g} instants a second. Errors are of inverse depth, as parallax in the next rig's "
        "picture, where the background is known; shares in per cent.\n\n{}\n{}\n",
        wanted.rigs.size.width, wanted.rigs.size.height, wanted.apart_deg, wanted.rigs.noise_sigma,
        wanted.seconds, wanted.rate_hz, head, rule);
    for (const std::uint64_t scene : wanted.scenes) text += rows(library, wanted, scene);
    return text;
}

}  // namespace vantage
