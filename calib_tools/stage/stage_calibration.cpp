#include "calib_tools/stage/stage_calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "calib_tools/board/chessboard_finder.h"
#include "calib_tools/rig/view_rejection.h"
#include "calib_tools/stage/board_scale.h"
#include "common/base/error.h"

namespace vantage {
namespace {

constexpr int few_shared = StageCalibration::few_shared;
constexpr double weak_sigma_m = 0.002;
const LensFamily& held_family() { return lens_family("none"); }

/// Of every rig and instant: the board in the rig's frame, from the camera that saw more of it.
using BoardPoses = std::vector<std::map<long long, Pose>>;

BoardPoses pose_boards(const std::vector<StageRig>& rigs) {
    BoardPoses poses(rigs.size());
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        const StereoCalibration& c = rigs[i].calibration;
        for (const auto& [instant, corners] : rigs[i].right)
            if (const auto pose = estimate_board_pose(c.right, corners))
                poses[i][instant] = c.right_from_left.inverse() * *pose;
        for (const auto& [instant, corners] : rigs[i].left) {
            const auto other = rigs[i].right.find(instant);
            if (other != rigs[i].right.end() && other->second.size() > corners.size()) continue;
            if (const auto pose = estimate_board_pose(c.left, corners)) poses[i][instant] = *pose;
        }
    }
    return poses;
}

std::vector<long long> shared_instants(const std::map<long long, Pose>& a,
                                       const std::map<long long, Pose>& b) {
    std::vector<long long> shared;
    for (const auto& [instant, pose] : a)
        if (b.contains(instant)) shared.push_back(instant);
    return shared;
}

/// Places rigs one by one, always the one with the most instants shared with a rig that stands.
std::vector<Pose> place_rigs(const std::vector<StageRig>& rigs, const BoardPoses& poses) {
    std::vector<Pose> world_from_rig(rigs.size(), Pose::Identity());
    std::vector<bool> placed(rigs.size(), false);
    placed[0] = true;
    for (std::size_t step = 1; step < rigs.size(); ++step) {
        std::size_t from = 0, to = 0, most = 0;
        for (std::size_t a = 0; a < rigs.size(); ++a)
            for (std::size_t b = 0; b < rigs.size(); ++b) {
                if (!placed[a] || placed[b]) continue;
                const std::size_t shared = shared_instants(poses[a], poses[b]).size();
                if (shared > most) {
                    most = shared;
                    from = a;
                    to = b;
                }
            }
        if (most == 0) {
            std::string standing, lost;
            for (std::size_t i = 0; i < rigs.size(); ++i)
                (placed[i] ? standing : lost) +=
                    ((placed[i] ? standing : lost).empty() ? "" : ", ") + rigs[i].name;
            fail(
                "no picture shows the board to {} and to {} at the same instant: hold the board "
                "where one of the first and one of the second see it, and take pictures there",
                lost, standing);
        }
        std::vector<Pose> candidates;
        for (const long long instant : shared_instants(poses[from], poses[to]))
            candidates.push_back(poses[from].at(instant) * poses[to].at(instant).inverse());
        world_from_rig[to] = world_from_rig[from] * middle_pose(candidates).right_from_left;
        placed[to] = true;
    }
    return world_from_rig;
}

struct Instants {
    std::vector<long long> numbers;
    std::map<long long, int> index;
};

void require_described_size(const std::vector<StageRig>& rigs, const BoardPattern& pattern) {
    // Noise at the far end of a stage reaches a percent; boards differ by more.
    constexpr double most = 0.03;
    const std::optional<double> scale = board_scale(rigs);
    if (scale && std::abs(*scale - 1) > most)
        fail(
            "the board's squares are {:.4f} m wide by the rigs' own baselines and {:.4f} m by its "
            "description: this is another board, or the rigs were calibrated with a wrong size; "
            "measure a row of squares",
            *scale * pattern.square_m, pattern.square_m);
}

Instants gather_instants(const BoardPoses& poses) {
    std::set<long long> all;
    for (const auto& of_rig : poses)
        for (const auto& [instant, pose] : of_rig) all.insert(instant);
    Instants result;
    for (const long long instant : all) {
        result.index[instant] = static_cast<int>(result.numbers.size());
        result.numbers.push_back(instant);
    }
    return result;
}

const CalibrationSigma::Camera& sigma_of(const CalibrationSigma& sigma, bool is_left) {
    return is_left ? sigma.left : sigma.right;
}

/// The family whose free coefficients are those that the rig's own calibration solved; null if the
/// rig does not know, and its lenses are held.
const LensFamily* solved_family(const StageRig& rig, bool is_left) {
    if (!rig.sigma) return nullptr;
    const CalibrationSigma::Camera& sigma = sigma_of(*rig.sigma, is_left);
    const CameraModel& model = is_left ? rig.calibration.left : rig.calibration.right;
    if (!(sigma.fx_px > 0 && sigma.fy_px > 0 && sigma.cx_px > 0 && sigma.cy_px > 0) ||
        !(rig.sigma->rotation_rad.minCoeff() > 0 && rig.sigma->translation_m.minCoeff() > 0))
        return nullptr;
    for (const LensFamily& family : lens_families()) {
        bool same = family.lens == model.lens &&
                    static_cast<std::size_t>(family.stored_coefficients) == model.distortion.size();
        for (std::size_t k = 0; same && k < model.distortion.size(); ++k)
            same = family.free[k] == (sigma.distortion[k] > 0);
        if (same) return &family;
    }
    return nullptr;
}

CameraPrior prior_of(const StageRig& rig, bool is_left) {
    const CalibrationSigma::Camera& sigma = sigma_of(*rig.sigma, is_left);
    CameraPrior prior;
    prior.model = is_left ? rig.calibration.left : rig.calibration.right;
    prior.focal_and_centre_sigma_px = {sigma.fx_px, sigma.fy_px, sigma.cx_px, sigma.cy_px};
    prior.distortion_sigma = sigma.distortion;
    if (!is_left) {
        prior.camera_from_rig = rig.calibration.right_from_left;
        prior.rotation_sigma_rad = rig.sigma->rotation_rad;
        prior.translation_sigma_m = rig.sigma->translation_m;
    }
    return prior;
}

Bundle make_bundle(const std::vector<StageRig>& rigs, const BoardPoses& poses,
                   const Instants& instants, const std::vector<Pose>& world_from_rig) {
    Bundle bundle;
    bundle.boards.resize(instants.numbers.size());
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        const StereoCalibration& c = rigs[i].calibration;
        bundle.rigs.push_back({world_from_rig[i], i > 0});
        for (const bool is_left : {true, false}) {
            BundleCamera camera;
            camera.model = is_left ? c.left : c.right;
            camera.family = &held_family();
            camera.rig = static_cast<int>(i);
            camera.camera_from_rig = is_left ? Pose::Identity() : c.right_from_left;
            camera.solve_lens = false;
            if (const LensFamily* family = solved_family(rigs[i], is_left)) {
                camera.family = family;
                camera.solve_lens = true;
                camera.solve_pose = !is_left;
                camera.prior = prior_of(rigs[i], is_left);
            }
            for (const auto& [instant, corners] : is_left ? rigs[i].left : rigs[i].right)
                if (poses[i].contains(instant))
                    bundle.views.push_back({static_cast<int>(bundle.cameras.size()),
                                            instants.index.at(instant), corners});
            bundle.cameras.push_back(camera);
        }
        for (const auto& [instant, pose] : poses[i])
            bundle.boards[static_cast<std::size_t>(instants.index.at(instant))].world_from_board =
                world_from_rig[i] * pose;
    }
    return bundle;
}

/// y up, the middle of the board at the origin; z of the board points into the floor.
Pose world_from_floor_board(const BoardPattern& pattern) {
    Pose pose = Pose::Identity();
    pose.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    pose.translation() = -(pose.linear() * (0.5 * pattern.corner_m(pattern.corner_count() - 1)));
    return pose;
}

/// Lenses and baseline of rig `index` as the stage's pictures moved them, rectified anew.
void take_refined(const Bundle& bundle, const BundleUncertainty& uncertainty, std::size_t index,
                  double alpha, StageCalibration::Rig& rig) {
    StereoCalibration& c = rig.calibration;
    const StereoCalibration before = c;
    const BundleCamera& left = bundle.cameras[2 * index];
    const BundleCamera& right = bundle.cameras[2 * index + 1];
    c.left = left.model;
    c.right = right.model;
    c.right_from_left = right.camera_from_rig;
    compute_rectification(c, alpha);
    rig.refined = true;
    rig.focal_change = std::max(std::abs(c.left.fx_px / before.left.fx_px - 1),
                                std::abs(c.right.fx_px / before.right.fx_px - 1));
    rig.baseline_change_m =
        c.right_from_left.translation().norm() - before.right_from_left.translation().norm();
    rig.sigma = CalibrationSigma{camera_sigma(uncertainty.cameras[2 * index]),
                                 camera_sigma(uncertainty.cameras[2 * index + 1]),
                                 uncertainty.cameras[2 * index + 1].rotation_rad,
                                 uncertainty.cameras[2 * index + 1].translation_m};
}

void advise(StageCalibration& stage) {
    for (std::size_t i = 1; i < stage.rigs.size(); ++i) {
        const StageCalibration::Tie* best = nullptr;
        for (const StageCalibration::Tie& tie : stage.ties)
            if ((tie.a == i || tie.b == i) && (!best || tie.shared > best->shared)) best = &tie;
        const StageCalibration::Rig& rig = stage.rigs[i];
        if (best->shared >= few_shared && rig.translation_sigma_m < weak_sigma_m) continue;
        const std::string& other = stage.rigs[best->a == i ? best->b : best->a].name;
        stage.advice.push_back(fmt::format(
            "rig {} is weakly tied (uncertain by {:.1f} mm and {:.3f} degrees; {} instants shared "
            "with {}, the most with any): take {} more pictures of the board where {} and {} both "
            "see it large and tilted",
            rig.name, 1000 * rig.translation_sigma_m,
            rig.rotation_sigma_rad * 180 / std::numbers::pi, best->shared, other,
            std::max(3, 2 * few_shared - best->shared), rig.name, other));
    }
}

}  // namespace

StageCalibration calibrate_stage(const std::vector<StageRig>& rigs, const BoardPattern& pattern,
                                 std::optional<long long> floor_instant) {
    if (rigs.size() < 2) fail("a stage needs at least two rigs; one was given");
    if (pattern.kind == BoardKind::chessboard && looks_alike_half_turned(pattern))
        fail(
            "a {} chessboard looks the same when turned half round, so rigs that see it from "
            "different sides cannot agree: take one with an odd and an even count of corners, or "
            "a ChArUco board",
            pattern.size_name());
    const BoardPoses poses = pose_boards(rigs);
    for (std::size_t i = 0; i < rigs.size(); ++i)
        if (poses[i].empty()) fail("rig {} saw the board in none of its pictures", rigs[i].name);
    require_described_size(rigs, pattern);
    const Instants instants = gather_instants(poses);
    Bundle bundle = make_bundle(rigs, poses, instants, place_rigs(rigs, poses));
    std::vector<RejectedView> bad;
    std::size_t corners_left_out = 0;
    // Lenses are let go once the rigs stand and the corners' own spread is known.
    Bundle held = bundle;
    for (BundleCamera& camera : held.cameras) {
        camera.solve_lens = camera.solve_pose = false;
        camera.prior.reset();
    }
    if (!solve_robustly(held))
        fail(
            "the rigs' pictures contradict each other: check that equal numbers are equal instants "
            "and that no rig was moved");
    bundle.rigs = held.rigs;
    bundle.boards = held.boards;
    bundle.corner_sigma_px = std::max(0.01, robust_sigma_px(held));
    if (!solve_robustly(bundle) || !reject_bad_views(bundle, bad, corners_left_out))
        fail(
            "the rigs' pictures contradict each other: check that equal numbers are equal instants "
            "and that no rig was moved");

    StageCalibration stage;
    stage.instants_given = instants.numbers.size();
    for (const RejectedView& view : bad)
        stage.rejected.push_back(
            {fmt::format("instant {}", instants.numbers[static_cast<std::size_t>(view.board)]),
             fmt::format("contradicts the others: its corners miss the model by {:.2f} px where "
                         "{:.2f} px is usual",
                         view.rms_px, view.usual_rms_px)});
    std::map<int, std::set<std::size_t>> rigs_of_board;
    for (const BundleView& view : bundle.views)
        rigs_of_board[view.board].insert(
            static_cast<std::size_t>(bundle.cameras[static_cast<std::size_t>(view.camera)].rig));
    stage.instants_used = rigs_of_board.size();
    stage.rms_px = bundle.rms_px();
    if (!(stage.rms_px < 2))
        fail(
            "the corners miss the stage's best model by {:.1f} px RMS, more than 2 px: a rig's "
            "calibration is not its own, a rig was moved, or equal numbers are not equal instants",
            stage.rms_px);
    for (std::size_t a = 0; a < rigs.size(); ++a)
        for (std::size_t b = a + 1; b < rigs.size(); ++b) {
            int shared = 0;
            for (const auto& [board, seen_by] : rigs_of_board)
                shared += seen_by.contains(a) && seen_by.contains(b) ? 1 : 0;
            stage.ties.push_back({a, b, shared});
        }

    Pose world_from_start = Pose::Identity();
    if (floor_instant) {
        const auto index = instants.index.find(*floor_instant);
        if (index == instants.index.end() || !rigs_of_board.contains(index->second))
            fail("no rig could use a picture with number {} of the board on the floor",
                 *floor_instant);
        world_from_start =
            world_from_floor_board(pattern) *
            bundle.boards[static_cast<std::size_t>(index->second)].world_from_board.inverse();
        stage.has_floor = true;
    }
    const BundleUncertainty uncertainty = bundle_uncertainty(bundle);
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        StageCalibration::Rig rig;
        rig.name = rigs[i].name;
        rig.calibration = rigs[i].calibration;
        rig.calibration.world_from_left = world_from_start * bundle.rigs[i].world_from_rig;
        if (solved_family(rigs[i], true)) take_refined(bundle, uncertainty, i, rigs[i].alpha, rig);
        rig.translation_sigma_m = uncertainty.rigs[i].translation_m.norm();
        rig.rotation_sigma_rad = uncertainty.rigs[i].rotation_rad.norm();
        double squares = 0, corners = 0;
        for (const BundleView& view : bundle.views) {
            if (bundle.cameras[static_cast<std::size_t>(view.camera)].rig != static_cast<int>(i))
                continue;
            const auto count = static_cast<double>(view.corners.size());
            squares += std::pow(bundle.view_rms_px(view), 2) * count;
            corners += count;
        }
        rig.rms_px = corners > 0 ? std::sqrt(squares / corners) : 0;
        for (const auto& [board, seen_by] : rigs_of_board)
            rig.instants += seen_by.contains(i) ? 1 : 0;
        if (rig.instants == 0)
            fail(
                "every picture of rig {} contradicts the other rigs: its calibration is not its "
                "own, or it was moved",
                rig.name);
        stage.rigs.push_back(rig);
    }
    advise(stage);
    stage.bundle = std::move(bundle);
    stage.instant_numbers = instants.numbers;
    return stage;
}

}  // namespace vantage
