#include "calib_tools/rig/rig_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>

#include "calib_tools/rig/doubts.h"
#include "calib_tools/rig/guidance.h"
#include "calib_tools/rig/view_rejection.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/board/chessboard_finder.h"

namespace vantage {
namespace {

constexpr std::size_t fewest_views = 3;
constexpr double max_focal_uncertainty = 0.05;
/// Largest spread of the relative pose over the views of one rigid rig.
constexpr double max_rotation_spread_rad = 0.05, max_translation_spread = 0.3;
/// Corners are measured to 0.1 px; a bad webcam reaches 1 px.
constexpr double max_rms_share_of_width = 0.004;
/// Rectification rotates each image by half of this.
constexpr double max_roll_deg = 20;
/// If each camera alone fits well, pairs with this error do not belong together.
constexpr double max_rms_of_loose_pairs_px = 1;

std::string pair_name(const SeenPicture& left, const SeenPicture& right) {
    return left.name() + ", " + right.name();
}

CameraViews views_of(const std::vector<SeenPicture>& pictures) {
    CameraViews views;
    for (const SeenPicture& p : pictures) {
        if (p.sighting.found()) {
            views.width_px = p.width_px;
            views.height_px = p.height_px;
        }
        views.instants.push_back(p.sighting.corners);
    }
    return views;
}

std::size_t usable_count(const CameraViews& views) {
    return static_cast<std::size_t>(
        std::count_if(views.instants.begin(), views.instants.end(),
                      [](const BoardCorners& corners) { return !corners.empty(); }));
}

void require_enough(std::size_t usable, std::size_t given, const std::vector<Refusal>& rejected,
                    const BoardPattern& pattern, const char* what) {
    if (usable >= fewest_views) return;
    const std::string example =
        rejected.empty() ? ""
                         : fmt::format("; {} {}", rejected.front().name, rejected.front().reason);
    fail("only {} of {} {} show the {} board, at least {} are needed and 10 are good{}", usable,
         given, what, pattern.size_name(), fewest_views, example);
}

void require_trustworthy(const Bundle& bundle, const BundleUncertainty& uncertainty,
                         const std::vector<std::string>& camera_names) {
    for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
        const CameraModel& m = bundle.cameras[i].model;
        const std::string fault = implausibility(m);
        if (!fault.empty())
            fail(
                "the pictures of the {} camera lead to {}: show the board tilted in several "
                "directions and in every part of the picture",
                camera_names[i], fault);
        const double relative = std::max(uncertainty.cameras[i].fx_px / m.fx_px,
                                         uncertainty.cameras[i].fy_px / m.fy_px);
        if (!(relative < max_focal_uncertainty))
            fail(
                "the focal length of the {} camera is uncertain by {:.0f} %, more than {:.0f} %: "
                "add pictures of the board tilted by 30 degrees, left, right, up and down",
                camera_names[i], 100 * relative, 100 * max_focal_uncertainty);
        const double limit = std::max(1.0, max_rms_share_of_width * m.width_px);
        if (!(bundle.rms_px() < limit))
            fail(
                "the corners miss the best model by {:.2f} px RMS, more than {:.2f} px: the board "
                "is not flat, its squares are not equal, or it moved while a picture was taken",
                bundle.rms_px(), limit);
    }
}

std::string contradiction(const RejectedView& view) {
    return fmt::format(
        "contradicts the others: its corners miss the model by {:.2f} px where "
        "{:.2f} px is usual",
        view.rms_px, view.usual_rms_px);
}

/// The views of a mirrored image, with the corner numbers that detection would give.
CameraViews mirrored(const CameraViews& views, const BoardPattern& pattern) {
    CameraViews result = views;
    // Two numberings face the front again; the one that keeps black squares black is right.
    const bool swap_rows = pattern.columns % 2 == 1 && pattern.rows % 2 == 0;
    for (BoardCorners& corners : result.instants) {
        for (BoardCorner& corner : corners) {
            corner.pixel.x() = views.width_px - 1 - corner.pixel.x();
            const int column = corner.id % pattern.columns, row = corner.id / pattern.columns;
            corner.id = swap_rows ? (pattern.rows - 1 - row) * pattern.columns + column
                                  : row * pattern.columns + pattern.columns - 1 - column;
            corner.board_m = pattern.corner_m(corner.id);
        }
        std::sort(corners.begin(), corners.end(),
                  [](const BoardCorner& a, const BoardCorner& b) { return a.id < b.id; });
    }
    return result;
}

bool agrees(const PairStart& start) {
    return start.rotation_spread_rad < max_rotation_spread_rad &&
           start.translation_spread_m <
               max_translation_spread * start.right_from_left.translation().norm();
}

/// Shifts the right camera's views in the series, as if an image at the start of one series were
/// missing.
CameraViews shifted(const CameraViews& views, int by) {
    CameraViews result = views;
    const int count = static_cast<int>(views.instants.size());
    for (int i = 0; i < count; ++i) {
        const int from = i + by;
        result.instants[static_cast<std::size_t>(i)] =
            from >= 0 && from < count ? views.instants[static_cast<std::size_t>(from)]
                                      : BoardCorners{};
    }
    return result;
}

/// Throws Error with the most likely reason why the two series are not of one rig.
[[noreturn]] void explain_disagreement(const CameraViews& right, const Bundle& left_solved,
                                       const PairStart& start, const BoardPattern& pattern) {
    const LensFamily& family = *left_solved.cameras.front().family;
    const auto fits = [&](const CameraViews& views) {
        if (usable_count(views) < fewest_views) return false;
        const std::optional<Bundle> solved = solve_camera(views, family);
        if (!solved) return false;
        const std::optional<PairStart> other = start_pair(left_solved, *solved);
        return other && agrees(*other);
    };
    if (fits(mirrored(right, pattern)))
        fail(
            "left and right pictures are mirrored against each other: turn mirroring off at one "
            "of the two cameras");
    for (const int by : {1, -1, 2, -2})
        if (fits(shifted(right, by)))
            fail(
                "the pairs are out of step: every left picture fits the right one {} {}; give the "
                "pictures of a pair the same number",
                std::abs(by) == 1 ? "that is one place" : "that is two places",
                by > 0 ? "further" : "earlier");
    fail(
        "the pairs contradict each other: the right camera's place jumps by {:.3f} m and {:.1f} "
        "degrees from pair to pair (left: {} pictures), so the pictures of a pair are not of one "
        "instant, or the cameras moved on the rig",
        start.translation_spread_m, start.rotation_spread_rad * 57.29578, left_solved.views.size());
}

void refuse_impossible_rig(const Pose& right_from_left) {
    const double roll = roll_between_deg(right_from_left);
    if (std::abs(roll) > max_roll_deg)
        fail(
            "the right camera is turned by {:.0f} degrees about its axis against the left one, "
            "more than {:.0f}: mount both the same way up, or turn the pictures of one of them",
            roll, max_roll_deg);
    const Eigen::Vector3d right_in_left = right_from_left.inverse().translation();
    if (std::abs(right_in_left.y()) > std::abs(right_in_left.x()))
        fail(
            "the cameras stand above each other ({:.3f} m down, {:.3f} m to the right): a rig "
            "needs "
            "them side by side; turn the pictures by 90 degrees",
            right_in_left.y(), right_in_left.x());
    if (right_in_left.x() < 0)
        fail(
            "left and right are swapped: the right pictures were taken {:.3f} m to the LEFT of the "
            "left ones; swap --left and --right (or, if both cameras stand upside down or deliver "
            "mirrored pictures, turn the pictures, or mirroring off)",
            -right_in_left.x());
}

LensChoice lenses_for(const std::vector<CameraViews>& cameras, const RigOptions& options) {
    return options.family ? use_lens(cameras, *options.family) : choose_lens(cameras);
}

double chosen_held_out_px(const LensChoice& lenses) {
    for (const LensTrial& trial : lenses.trials)
        if (trial.family == lenses.family) return trial.held_out_rms_px;
    return 0;
}

/// Gives a board that looks the same after half a turn the same numbering in both images.
void align_numbering(std::vector<SeenPicture>& left, std::vector<SeenPicture>& right,
                     const BoardPattern& pattern) {
    if (pattern.kind != BoardKind::chessboard || !looks_alike_half_turned(pattern)) return;
    const auto direction = [](const BoardCorners& corners) -> Eigen::Vector2d {
        return corners.back().pixel - corners.front().pixel;
    };
    for (std::size_t i = 0; i < left.size(); ++i) {
        const BoardCorners& l = left[i].sighting.corners;
        BoardCorners& r = right[i].sighting.corners;
        if (!l.empty() && !r.empty() && direction(l).dot(direction(r)) < 0)
            r = half_turned(r, pattern);
    }
}

/// Warnings about cameras that are turned against each other: they share little of their view,
/// their rectified images are enlarged until no pixel is empty, or one of them is rolled.
std::vector<std::string> doubt_rectification(const StereoCalibration& rig, const PairAim& aim) {
    std::vector<std::string> doubts;
    const double scale = static_cast<double>(rig.rectified.width_px) / rig.left.width_px;
    const double enlarged = rig.rectified.f_px / (scale * rig.left.fx_px);
    const double apart_deg =
        Eigen::AngleAxisd(Eigen::Matrix3d(rig.right_from_left.linear())).angle() * 180 /
        std::numbers::pi;
    constexpr double most_enlarged = 1.4, most_apart_deg = 10, most_level_roll_deg = 2;
    if (enlarged >= most_enlarged || apart_deg >= most_apart_deg)
        doubts.push_back(fmt::format(
            "the rectified pictures are enlarged {:.1f} times and the cameras look {:.0f} degrees "
            "apart: much of what they see is cut off; mount them parallel, or keep more with "
            "--alpha 1",
            enlarged, apart_deg));
    const double far_m = farthest_m(rig.rectified);
    if (std::isfinite(far_m))
        doubts.push_back(fmt::format(
            "the cameras are toed in by {:.1f} degrees and share {:.0f} % of their view far away: "
            "each side has its own principal point, so that the disparity is 0 at {:.3g} m and "
            "nothing beyond is measured; --far-m states another distance",
            aim.toe_in_deg, 100 * shared_view(rig, std::numeric_limits<double>::infinity()),
            far_m));
    constexpr double least_kept = 0.8;
    const double kept = aim.crossing_m > 0 ? kept_view(rig, aim.crossing_m) : 1;
    if (kept < least_kept)
        doubts.push_back(fmt::format(
            "of what both cameras see at {:.3g} m, where their axes cross, the rectified pictures "
            "keep {:.0f} %: what stands beside that place is cut off; --alpha 1 keeps all of it, "
            "and a nearer --far-m more of it",
            aim.crossing_m, 100 * kept));
    if (std::abs(aim.roll_deg) > most_level_roll_deg)
        doubts.push_back(fmt::format(
            "the right camera is rolled by {:.1f} degrees about its axis against the left one: "
            "rectification turns both pictures by half of it; mount both level",
            aim.roll_deg));
    return doubts;
}

/// Removes the pairs that contradict most others from the series, each with its reason. Returns
/// true if there is one.
bool leave_out_outlying_pairs(const LensChoice& lenses, const PairStart& start,
                              const BoardPattern& pattern, std::vector<SeenPicture>& left,
                              std::vector<SeenPicture>& right, std::vector<Refusal>& rejected) {
    const bool is_alike = pattern.kind == BoardKind::chessboard && looks_alike_half_turned(pattern);
    const std::vector<OutlyingPair> outlying =
        outlying_pairs(lenses.cameras[0], lenses.cameras[1], start, is_alike);
    for (const OutlyingPair& pair : outlying) {
        const auto at = static_cast<std::size_t>(pair.board);
        const char* turned =
            "is turned half round against the other pictures of its camera: turn it back";
        switch (pair.cause) {
            case OutlyingPair::Cause::left_half_turned:
                rejected.push_back({left[at].name(), turned});
                break;
            case OutlyingPair::Cause::right_half_turned:
                rejected.push_back({right[at].name(), turned});
                break;
            case OutlyingPair::Cause::other:
                rejected.push_back(
                    {pair_name(left[at], right[at]),
                     fmt::format("contradicts the other pairs by {:.0f} px: the two pictures are "
                                 "not of one instant, or the cameras moved on the rig",
                                 pair.misfit_px)});
        }
        left[at].sighting.corners.clear();
        right[at].sighting.corners.clear();
    }
    return !outlying.empty();
}

/// Counts the pairs in the solution, and lists those with too few corners left.
std::size_t name_pairs_without_corners(const Bundle& pair, const CameraViews& given,
                                       const std::vector<RejectedView>& rejected,
                                       RigCalibration& result) {
    std::map<int, int> sides;
    for (const BundleView& view : pair.views) ++sides[view.board];
    std::size_t used = 0;
    for (std::size_t i = 0; i < given.instants.size(); ++i) {
        const int board = static_cast<int>(i);
        const auto found = sides.find(board);
        if (found != sides.end()) ++used;
        const bool is_whole = found != sides.end() && found->second == 2;
        const bool is_named =
            std::any_of(rejected.begin(), rejected.end(),
                        [&](const RejectedView& view) { return view.board == board; });
        if (is_whole || is_named || given.instants[i].empty()) continue;
        result.rejected.push_back(
            {result.names[i],
             found == sides.end()
                 ? "is left out: fewer than 4 of its corners agree with the other pairs"
                 : "is used on one side only: on the other fewer than 4 of its corners agree with "
                   "the other pairs"});
    }
    return used;
}

}  // namespace

CameraCalibration calibrate_camera(std::vector<SeenPicture> pictures, const BoardPattern& pattern,
                                   const RigOptions& options) {
    CameraCalibration result;
    result.views_given = pictures.size();
    result.printed = printed_board_of(pictures);
    require_one_size(pictures);
    refuse_wrong_board(pictures, pattern);
    refuse_repeated(pictures);
    for (const SeenPicture& p : pictures) {
        result.names.push_back(p.name());
        if (!p.sighting.found()) result.rejected.push_back({p.name(), p.sighting.reason});
    }
    const CameraViews views = views_of(pictures);
    require_enough(usable_count(views), result.views_given, result.rejected, pattern, "pictures");

    LensChoice lenses = lenses_for({views}, options);
    result.bundle = lenses.cameras.front();
    std::vector<RejectedView> bad;
    if (!reject_bad_views(result.bundle, bad, result.corners_left_out))
        fail("the calibration diverged after views that contradict the others were left out");
    for (const RejectedView& view : bad)
        result.rejected.push_back(
            {result.names[static_cast<std::size_t>(view.board)], contradiction(view)});
    for (std::size_t i = 0; i < views.instants.size(); ++i) {
        const auto is_this = [&](const auto& view) { return view.board == static_cast<int>(i); };
        if (!views.instants[i].empty() && std::none_of(bad.begin(), bad.end(), is_this) &&
            std::none_of(result.bundle.views.begin(), result.bundle.views.end(), is_this))
            result.rejected.push_back(
                {result.names[i],
                 "is left out: fewer than 4 of its corners agree with the other pictures"});
    }
    result.trials = lenses.trials;
    result.views_used = result.bundle.views.size();
    require_enough(result.views_used, result.views_given, result.rejected, pattern, "pictures");
    result.uncertainty = bundle_uncertainty(result.bundle);
    require_trustworthy(result.bundle, result.uncertainty, {"calibrated"});
    result.doubts = doubts_of(result.bundle, result.uncertainty,
                              {{"calibrated"}, chosen_held_out_px(lenses), 0});
    result.advice = missing_pictures(result.bundle, 0, "calibrated");
    return result;
}

RigCalibration calibrate_rig(std::vector<SeenPicture> left, std::vector<SeenPicture> right,
                             const BoardPattern& pattern, const RigOptions& options) {
    RigCalibration result;
    result.views_given = left.size();
    require_one_size(left);
    require_one_size(right);
    std::vector<SeenPicture> both = left;
    both.insert(both.end(), right.begin(), right.end());
    result.printed = printed_board_of(both);
    refuse_wrong_board(both, pattern);
    refuse_repeated(left);
    refuse_repeated(right);
    align_numbering(left, right, pattern);
    for (std::size_t i = 0; i < left.size(); ++i) {
        result.names.push_back(pair_name(left[i], right[i]));
        BoardSighting& l = left[i].sighting;
        BoardSighting& r = right[i].sighting;
        if (!l.found()) result.rejected.push_back({left[i].name(), l.reason});
        if (!r.found()) result.rejected.push_back({right[i].name(), r.reason});
        if (!l.found() || !r.found()) {
            l.corners.clear();
            r.corners.clear();
        }
    }
    CameraViews left_views = views_of(left), right_views = views_of(right);
    require_enough(usable_count(left_views), result.views_given, result.rejected, pattern, "pairs");
    if (left_views.width_px != right_views.width_px ||
        left_views.height_px != right_views.height_px)
        fail(
            "the left pictures are {}x{} and the right ones {}x{}: both cameras of a rig must run "
            "at one resolution",
            left_views.width_px, left_views.height_px, right_views.width_px, right_views.height_px);

    LensChoice lenses = lenses_for({left_views, right_views}, options);
    std::optional<PairStart> start = start_pair(lenses.cameras[0], lenses.cameras[1]);
    if (!start) fail("no pair shows the board to both cameras");
    const double distance =
        lenses.cameras[0]
            .boards[static_cast<std::size_t>(lenses.cameras[0].views.front().board)]
            .world_from_board.translation()
            .norm();
    if (start->right_from_left.translation().norm() < 1e-3 * distance &&
        start->rotation_spread_rad < 1e-3)
        fail("left and right pictures are of one and the same camera: the baseline is 0");
    if (!agrees(*start)) explain_disagreement(right_views, lenses.cameras[0], *start, pattern);
    refuse_impossible_rig(start->right_from_left);
    if (leave_out_outlying_pairs(lenses, *start, pattern, left, right, result.rejected)) {
        left_views = views_of(left);
        right_views = views_of(right);
        require_enough(usable_count(left_views), result.views_given, result.rejected, pattern,
                       "pairs");
        lenses = lenses_for({left_views, right_views}, options);
        start = start_pair(lenses.cameras[0], lenses.cameras[1]);
        if (!start) fail("no pair shows the board to both cameras");
    }
    result.trials = lenses.trials;

    std::optional<Bundle> pair = solve_pair(lenses.cameras[0], lenses.cameras[1], *start);
    std::vector<RejectedView> bad;
    if (!pair || !reject_bad_views(*pair, bad, result.corners_left_out))
        fail(
            "the two cameras together lead to no calibration although each does alone: the "
            "pictures of a pair are not of one instant, or the cameras moved on the rig");
    for (const RejectedView& view : bad)
        result.rejected.push_back(
            {result.names[static_cast<std::size_t>(view.board)], contradiction(view)});
    result.bundle = *pair;
    result.views_used = name_pairs_without_corners(*pair, left_views, bad, result);
    require_enough(result.views_used, result.views_given, result.rejected, pattern, "pairs");
    result.uncertainty = bundle_uncertainty(*pair);
    const double alone_sigma_px =
        std::max(robust_sigma_px(lenses.cameras[0]), robust_sigma_px(lenses.cameras[1]));
    const std::string together = doubt_together(robust_sigma_px(*pair), alone_sigma_px);
    if (!together.empty() && pair->rms_px() > max_rms_of_loose_pairs_px) fail("{}", together);
    require_trustworthy(*pair, result.uncertainty, {"left", "right"});

    StereoCalibration frame;
    frame.left = pair->cameras[0].model;
    frame.right = pair->cameras[1].model;
    frame.right_from_left = pair->cameras[1].camera_from_rig;
    frame.rectified.width_px = options.rectified_width_px;
    frame.rectified.height_px = options.rectified_height_px;
    compute_rectification(frame, options.alpha);
    const double far_m = options.far_m.value_or(suitable_far_m(frame));
    compute_rectification_to(frame, options.alpha, far_m);
    result.aim = aim_of(frame);
    result.calibration = frame;
    const std::vector<double> rows = row_differences_px(frame, *pair);
    result.row_rms_px = root_mean_square(rows);
    for (const double row : rows) result.row_max_px = std::max(result.row_max_px, std::abs(row));
    const Eigen::Vector3d translation = frame.right_from_left.translation();
    result.baseline_m = translation.norm();
    result.baseline_sigma_m =
        result.uncertainty.cameras[1].translation_m.cwiseProduct(translation.normalized()).norm();
    result.doubts = doubts_of(*pair, result.uncertainty,
                              {{"left", "right"}, chosen_held_out_px(lenses), alone_sigma_px});
    for (std::string& sentence : doubt_rectification(frame, result.aim))
        result.doubts.push_back(std::move(sentence));
    for (const int side : {0, 1})
        for (std::string& sentence : missing_pictures(*pair, side, side == 0 ? "left" : "right"))
            result.advice.push_back(std::move(sentence));
    return result;
}

CalibrationSigma::Camera camera_sigma(const BundleUncertainty::Camera& camera) {
    return {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, camera.distortion};
}

CalibrationSigma calibration_sigma(const RigCalibration& rig) {
    const auto& [left, right] = std::tie(rig.uncertainty.cameras[0], rig.uncertainty.cameras[1]);
    return {camera_sigma(left), camera_sigma(right), right.rotation_rad, right.translation_m};
}

}  // namespace vantage
