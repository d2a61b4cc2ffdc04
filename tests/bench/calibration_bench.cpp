// How long a stage of four rigs takes from pictures to places, and how near to the truth it comes:
//   calibration_bench [views a rig] [width in px]

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <numbers>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "calib_tools/stage/stage_calibration.h"
#include "common/base/error.h"
#include "tests/support/boards/rendered_stage.h"

namespace vantage {
namespace {

class Clock {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    /// Of the processor, all threads: what is left of it on a machine that others use too.
    double cpu_seconds() const {
        return static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC;
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::clock_t cpu_start_ = std::clock();
};

/// Searches all pictures on all cores, as the commands do.
std::vector<BoardSighting> search(const std::vector<GreyImage>& pictures,
                                  const BoardPattern& pattern) {
    std::vector<BoardSighting> found(pictures.size());
    cv::parallel_for_(
        cv::Range(0, static_cast<int>(pictures.size())),
        [&](const cv::Range& range) {
            for (int i = range.start; i < range.end; ++i) {
                const auto index = static_cast<std::size_t>(i);
                found[index] = find_board(pictures[index], pattern);
            }
        },
        static_cast<double>(pictures.size()));
    return found;
}

/// Of `views` pairs a rig half are near it, for its lenses, and half are before neighbours.
void measure(int views, int width_px) {
    const BoardPattern pattern = chessboard_pattern("9x6", 0.1);
    RenderedStage stage(pattern, width_px, 11);
    double search_s = 0, rigs_s = 0, stage_s = 0, cpu_s = 0;
    std::vector<StageRig> rigs;
    double worst_focal_percent = 0;
    for (int r = 0; r < RenderedStage::rig_count; ++r) {
        std::vector<GreyImage> pictures;
        for (int i = 0; i < views / 2; ++i) {
            const Pose world_from_board = stage.world_from_board_near(r);
            for (const int side : {0, 1})
                pictures.push_back(stage.film(r, side, world_from_board, {}));
        }
        const Clock searching;
        const std::vector<BoardSighting> found = search(pictures, pattern);
        search_s += searching.seconds();
        cpu_s += searching.cpu_seconds();
        std::vector<SeenPicture> seen[2];
        for (std::size_t i = 0; i < found.size(); ++i) {
            SeenPicture picture;
            picture.path = fmt::format("{}.png", i / 2);
            picture.width_px = pictures[i].cols;
            picture.height_px = pictures[i].rows;
            picture.sighting = found[i];
            seen[i % 2].push_back(picture);
        }
        const Clock solving;
        const RigCalibration solved = calibrate_rig(seen[0], seen[1], pattern, {});
        rigs_s += solving.seconds();
        cpu_s += solving.cpu_seconds();
        worst_focal_percent =
            std::max(worst_focal_percent,
                     100 * std::abs(solved.calibration.left.fx_px / stage.truth(r).left.fx_px - 1));
        StageRig rig;
        rig.name = RenderedStage::name(r);
        rig.calibration = solved.calibration;
        rig.sigma = calibration_sigma(solved);
        rigs.push_back(rig);
    }
    long long instant = 0;
    const auto show = [&](const Pose& world_from_board, int first, int last) {
        std::vector<GreyImage> pictures;
        for (int r = first; r <= last; ++r)
            for (const int side : {0, 1})
                pictures.push_back(stage.film(r, side, world_from_board, {}));
        const Clock searching;
        const std::vector<BoardSighting> found = search(pictures, pattern);
        search_s += searching.seconds();
        cpu_s += searching.cpu_seconds();
        for (std::size_t i = 0; i < found.size(); ++i) {
            StageRig& rig = rigs[static_cast<std::size_t>(first) + i / 2];
            if (found[i].found()) (i % 2 == 0 ? rig.left : rig.right)[instant] = found[i].corners;
        }
        ++instant;
    };
    show(stage.board_on_floor(), 0, RenderedStage::rig_count - 1);
    // An outer rig has one neighbour, an inner one two: three gaps share four rigs' views.
    for (int pair = 0; pair + 1 < RenderedStage::rig_count; ++pair)
        for (int i = 0; i < views / 3; ++i) show(stage.board_before_pair(pair), pair, pair + 1);
    const Clock placing;
    const StageCalibration solved = calibrate_stage(rigs, pattern, 0);
    stage_s = placing.seconds();
    cpu_s += placing.cpu_seconds();
    double squares_mm = 0, squares_deg = 0;
    for (int r = 1; r < RenderedStage::rig_count; ++r) {
        const auto i = static_cast<std::size_t>(r);
        const Pose miss =
            (solved.rigs[0].calibration.world_from_left.inverse() *
             solved.rigs[i].calibration.world_from_left)
                .inverse() *
            (stage.truth(0).world_from_left.inverse() * stage.truth(r).world_from_left);
        squares_mm += 1e6 * miss.translation().squaredNorm() / 3;
        squares_deg += std::pow(Eigen::AngleAxisd(Eigen::Matrix3d(miss.linear())).angle() * 180 /
                                    std::numbers::pi,
                                2) /
                       3;
    }
    const double total_s = search_s + rigs_s + stage_s;
    std::cout << fmt::format(
        "4 rigs, {} views each, {} px wide, {} threads\nsearch {:.1f} s, rigs {:.1f} s, stage "
        "{:.1f} "
        "s, together {:.1f} s: {:.2f} of the 60 s allowed; {:.1f} s of processors' time\nfocal "
        "lengths within {:.4f} %, places "
        "{:.3f} mm and {:.4f} degrees RMS, {} of {} instants used\n",
        views, width_px, cv::getNumThreads(), search_s, rigs_s, stage_s, total_s, total_s / 60,
        cpu_s, worst_focal_percent, std::sqrt(squares_mm), std::sqrt(squares_deg),
        solved.instants_used, solved.instants_given);
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    try {
        vantage::measure(argc > 1 ? std::atoi(argv[1]) : 40, argc > 2 ? std::atoi(argv[2]) : 1280);
    } catch (const vantage::Error& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    return 0;
}
