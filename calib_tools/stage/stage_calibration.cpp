#include "calib_tools/stage/stage_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "calib_tools/rig/view_rejection.h"
#include "calib_tools/stage/repeated_sightings.h"
#include "calib_tools/stage/stage_graph.h"
#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/board/chessboard_finder.h"
#include "common/board/median.h"

namespace vantage {
namespace {

constexpr std::size_t fewest_instants = 3, fewest_corners = 6;

/// Nearest point of the two rays, in the left camera's frame.
Eigen::Vector3d triangulate(const StereoCalibration& rig, const Eigen::Vector2d& left_px,
                            const Eigen::Vector2d& right_px) {
    const Pose left_from_right = rig.right_from_left.inverse();
    const Eigen::Vector3d a = rig.left.unproject(left_px);
    const Eigen::Vector3d b = left_from_right.linear() * rig.right.unproject(right_px);
    Eigen::Matrix<double, 3, 2> rays;
    rays << a, -b;
    const Eigen::Vector2d along =
        rays.colPivHouseholderQr().solve(Eigen::Vector3d(left_from_right.translation()));
    return 0.5 * (along[0] * a + left_from_right.translation() + along[1] * b);
}

/// Scale of the similarity that maps the described corners to the measured ones (Umeyama, 1991).
std::optional<double> scale_of(const StereoCalibration& rig, const BoardCorners& left,
                               const BoardCorners& right) {
    std::map<int, Eigen::Vector2d> seen_right;
    for (const BoardCorner& corner : right) seen_right[corner.id] = corner.pixel;
    std::vector<Eigen::Vector3d> measured, described;
    for (const BoardCorner& corner : left) {
        const auto other = seen_right.find(corner.id);
        if (other == seen_right.end()) continue;
        measured.push_back(triangulate(rig, corner.pixel, other->second));
        described.push_back(corner.board_m);
    }
    if (measured.size() < fewest_corners) return std::nullopt;
    using Points = Eigen::Matrix3Xd;
    const auto count = static_cast<Eigen::Index>(measured.size());
    const Points from = Eigen::Map<const Points>(described.front().data(), 3, count);
    const Points to = Eigen::Map<const Points>(measured.front().data(), 3, count);
    return Eigen::umeyama(from, to, true).topLeftCorner<3, 3>().col(0).norm();
}

/// Size of a body's boards as measured with the rigs' baselines, relative to their description. It
/// is the median over all frame sets in which both cameras of a rig saw a board, of the scale that
/// fits the triangulated corners best; depth noise, which is large far away, does not bias it.
/// Empty for fewer than three such frame sets.
std::optional<double> board_scale(const std::vector<StageRig>& rigs, const BoardBody& body) {
    std::vector<double> scales;
    for (const StageRig& rig : rigs)
        for (const auto& [instant, left] : rig.left) {
            const auto right = rig.right.find(instant);
            if (right == rig.right.end()) continue;
            for (const int board : body.boards) {
                const auto wanted = [&](int each) { return each == board; };
                if (const auto scale = scale_of(rig.calibration, corners_of(left, wanted),
                                                corners_of(right->second, wanted)))
                    scales.push_back(*scale);
            }
        }
    if (scales.size() < fewest_instants) return std::nullopt;
    return median(scales);
}

constexpr int few_shared = StageCalibration::few_shared;
constexpr double weak_sigma_m = 0.002;
const LensFamily& held_family() { return lens_family("none"); }

void require_described_size(const std::vector<StageRig>& rigs, const CalibrationBoards& boards) {
    // Noise at the far end of a stage reaches 1 %; wrong board sizes differ by more.
    constexpr double most = 0.03;
    for (const BoardBody& body : boards.bodies) {
        const std::optional<double> scale = board_scale(rigs, body);
        const double square_m =
            boards.boards[static_cast<std::size_t>(body.boards.front())].square_m;
        if (scale && std::abs(*scale - 1) > most)
            fail(
                "the squares of {} are {:.4f} m wide by the rigs' own baselines and {:.4f} m by "
                "its description: this is another board, or the rigs were calibrated with a wrong "
                "size; measure a row of squares",
                boards.is_one_board() ? "the board" : body.name, *scale * square_m, square_m);
    }
}

/// Boards of the bundle: each is a body in one frame set.
struct Placements {
    std::vector<StageCalibration::Placement> list;
    std::map<std::pair<long long, int>, int> index;  ///< by frame set and body
};

Placements gather_placements(const StageStart& start) {
    std::set<std::pair<long long, int>> all;
    for (const auto& [key, pose] : start.rig_from_body)
        all.emplace(std::get<long long>(key), std::get<int>(key));
    Placements result;
    for (const auto& [instant, body] : all) {
        result.index[{instant, body}] = static_cast<int>(result.list.size());
        result.list.push_back({instant, body});
    }
    return result;
}

const CalibrationSigma::Camera& sigma_of(const CalibrationSigma& sigma, bool is_left) {
    return is_left ? sigma.left : sigma.right;
}

/// Family of the coefficients that the rig's own calibration solved for; null if the rig does not
/// state it, and its lenses are then held fixed.
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

/// Chooses, for each body, the pose with the smallest error over all rigs.
void place_bodies(const StageStart& start, const Placements& placements, Bundle& bundle) {
    constexpr double most_px = 50;
    std::vector<std::vector<const BundleView*>> views_of(bundle.boards.size());
    for (const BundleView& view : bundle.views)
        views_of[static_cast<std::size_t>(view.board)].push_back(&view);
    std::vector<double> least(bundle.boards.size(), std::numeric_limits<double>::max());
    std::vector<Pose> best(bundle.boards.size(), Pose::Identity());
    for (const auto& [key, rig_from_body] : start.rig_from_body) {
        const auto& [rig, instant, body] = key;
        const auto board = static_cast<std::size_t>(placements.index.at({instant, body}));
        bundle.boards[board].world_from_board = start.world_from_rig[rig] * rig_from_body;
        double miss = 0;
        for (const BundleView* view : views_of[board])
            for (const BoardCorner& corner : view->corners)
                miss += std::min(most_px, bundle.residual_px(*view, corner).norm());
        if (miss < least[board]) {
            least[board] = miss;
            best[board] = bundle.boards[board].world_from_board;
        }
    }
    for (std::size_t i = 0; i < best.size(); ++i) bundle.boards[i].world_from_board = best[i];
}

Bundle make_bundle(const std::vector<StageRig>& rigs, const StageStart& start,
                   const Placements& placements) {
    Bundle bundle;
    bundle.boards.resize(placements.list.size());
    if (std::any_of(start.bodies.begin(), start.bodies.end(),
                    [](const StageStart::Body& body) { return body.boards.size() > 1; })) {
        bundle.faces.resize(start.body_of_board.size());
        for (const StageStart::Body& body : start.bodies)
            for (const int board : body.boards)
                bundle.faces[static_cast<std::size_t>(board)] = {
                    start.body_from_board[static_cast<std::size_t>(board)],
                    board != body.boards.front()};
    }
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        const StereoCalibration& c = rigs[i].calibration;
        bundle.rigs.push_back({start.world_from_rig[i], i > 0});
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
                for (int body = 0; body < static_cast<int>(start.bodies.size()); ++body) {
                    if (!start.rig_from_body.contains({i, instant, body})) continue;
                    BoardCorners of_body = corners_of(corners, [&](int board) {
                        return start.body_of_board[static_cast<std::size_t>(board)] == body;
                    });
                    if (!of_body.empty())
                        bundle.views.push_back({static_cast<int>(bundle.cameras.size()),
                                                placements.index.at({instant, body}),
                                                std::move(of_body)});
                }
            bundle.cameras.push_back(camera);
        }
    }
    place_bodies(start, placements, bundle);
    return bundle;
}

/// Solves with priors weighted by the spread of the corners. While lenses are held fixed, the
/// errors of the rigs' own calibrations make corners seem worse than they are, and priors with that
/// weight would be too strong: the weight is therefore updated until it converges.
bool solve_weighed(Bundle& bundle, const Bundle& held) {
    constexpr int most_passes = 5;
    constexpr double close_enough = 0.03;
    double sigma_px = robust_sigma_px(held);
    for (int pass = 0; pass < most_passes; ++pass) {
        bundle.corner_sigma_px = std::max(0.01, sigma_px);
        if (!solve_robustly(bundle)) return false;
        const double before = std::exchange(sigma_px, robust_sigma_px(bundle));
        if (std::abs(sigma_px - before) < close_enough * before) break;
    }
    return true;
}

/// Finds the bundle's board on the floor: a flat board in that frame set, either the only one or
/// the named one.
int find_floor(const StageStart& start, const StageCalibration& stage, const Floor& floor,
               const std::set<int>& used) {
    const auto is_named = [&](const StageStart::Body& body) { return body.name == floor.board; };
    if (!floor.board.empty() && std::none_of(start.bodies.begin(), start.bodies.end(), is_named)) {
        std::string known;
        for (const StageStart::Body& body : start.bodies)
            known += (known.empty() ? "" : ", ") + body.name;
        fail("no board is named {}; there are {}", floor.board, known);
    }
    std::vector<int> flat;
    std::string names;
    for (int i = 0; i < static_cast<int>(stage.placements.size()); ++i) {
        const auto& [instant, body] = stage.placements[static_cast<std::size_t>(i)];
        const StageStart::Body& seen = start.bodies[static_cast<std::size_t>(body)];
        if (instant != floor.instant || !used.contains(i) || seen.boards.size() > 1) continue;
        if (!floor.board.empty() && floor.board != seen.name) continue;
        flat.push_back(i);
        names += (names.empty() ? "" : ", ") + seen.name;
    }
    if (flat.empty())
        fail("no rig could use a picture with number {} of {} on the floor", floor.instant,
             floor.board.empty() ? "the board" : floor.board);
    if (flat.size() > 1)
        fail("at instant {} the rigs see {}: say which lies on the floor (--floor-board NAME)",
             floor.instant, names);
    return flat.front();
}

/// Pose of the floor board in the world: y up, the centre of the board at the origin; z of the
/// board points into the floor.
Pose world_from_floor_board(const BoardPattern& pattern) {
    Pose pose = Pose::Identity();
    pose.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    pose.translation() = -(pose.linear() * (0.5 * pattern.corner_m(pattern.corner_count() - 1)));
    return pose;
}

/// Updates lenses and baseline of rig `index` from the stage's solution, and rectifies again.
void take_refined(const Bundle& bundle, const BundleUncertainty& uncertainty, std::size_t index,
                  double alpha, StageCalibration::Rig& rig) {
    StereoCalibration& c = rig.calibration;
    const StereoCalibration before = c;
    const BundleCamera& left = bundle.cameras[2 * index];
    const BundleCamera& right = bundle.cameras[2 * index + 1];
    c.left = left.model;
    c.right = right.model;
    c.right_from_left = right.camera_from_rig;
    compute_rectification_to(c, alpha, farthest_m(before.rectified));
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
            "rig {} is weakly tied (uncertain by {:.1f} mm and {:.3f} degrees; {} shared "
            "with {}, the most with any): take {} more pictures of the board where {} and {} both "
            "see it large and tilted",
            rig.name, 1000 * rig.translation_sigma_m, rig.rotation_sigma_deg(),
            counted(static_cast<std::size_t>(best->shared), "instant"), other,
            std::max(3, 2 * few_shared - best->shared), rig.name, other));
    }
}

}  // namespace

std::string StageCalibration::placement_name(int board) const {
    const Placement& placement = placements[static_cast<std::size_t>(board)];
    return bodies.size() == 1 ? fmt::format("instant {}", placement.instant)
                              : fmt::format("instant {}, {}", placement.instant,
                                            bodies[static_cast<std::size_t>(placement.body)].name);
}

StageCalibration calibrate_stage(const std::vector<StageRig>& given,
                                 const CalibrationBoards& boards,
                                 const std::optional<Floor>& floor) {
    if (given.size() < 2) fail("a stage needs at least two rigs; one was given");
    boards.validate();
    const BoardPattern& first = boards.boards.front();
    if (first.kind == BoardKind::chessboard && looks_alike_half_turned(first))
        fail(
            "a chessboard of {} corners looks the same when turned half round, so rigs that see it "
            "from "
            "different sides cannot agree: take one with an odd and an even count of corners, or "
            "a ChArUco board",
            first.size_name());
    const std::vector<StageRig> rigs =
        without_repeats(given, floor ? std::optional(floor->instant) : std::nullopt);
    const StageStart start = start_stage(rigs, boards);
    require_described_size(rigs, boards);
    const Placements placements = gather_placements(start);
    Bundle bundle = make_bundle(rigs, start, placements);
    std::vector<RejectedView> bad;
    std::size_t corners_left_out = 0;
    // Lenses are freed once the rigs are placed and the corners' own spread is known.
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
    bundle.faces = held.faces;
    if (!solve_weighed(bundle, held) || !reject_bad_views(bundle, bad, corners_left_out))
        fail(
            "the rigs' pictures contradict each other: check that equal numbers are equal instants "
            "and that no rig was moved");

    StageCalibration stage;
    stage.placements = placements.list;
    for (const StageStart::Body& body : start.bodies)
        stage.bodies.push_back({body.name, body.boards, {}, {}});
    for (const RejectedView& view : bad)
        stage.rejected.push_back(
            {stage.placement_name(view.board),
             fmt::format("contradicts the others: its corners miss the model by {:.2f} px where "
                         "{:.2f} px is usual",
                         view.rms_px, view.usual_rms_px)});
    std::map<int, std::set<std::size_t>> rigs_of_board;
    for (const BundleView& view : bundle.views)
        rigs_of_board[view.board].insert(
            static_cast<std::size_t>(bundle.cameras[static_cast<std::size_t>(view.camera)].rig));
    const auto instant_of = [&](int board) {
        return stage.placements[static_cast<std::size_t>(board)].instant;
    };
    std::set<long long> new_instants, used;
    std::set<int> used_boards;
    for (const StageCalibration::Placement& placement : stage.placements)
        new_instants.insert(placement.instant);
    for (const auto& [board, seen_by] : rigs_of_board) {
        used.insert(instant_of(board));
        used_boards.insert(board);
    }
    stage.instants_given = new_instants.size();
    stage.instants_used = used.size();
    stage.rms_px = bundle.rms_px();
    if (!(stage.rms_px < 2))
        fail(
            "the corners miss the stage's best model by {:.1f} px RMS, more than 2 px: a rig's "
            "calibration is not its own, a rig was moved, or equal numbers are not equal instants",
            stage.rms_px);
    for (std::size_t a = 0; a < rigs.size(); ++a)
        for (std::size_t b = a + 1; b < rigs.size(); ++b) {
            std::set<long long> shared;
            for (const auto& [board, seen_by] : rigs_of_board)
                if (seen_by.contains(a) && seen_by.contains(b)) shared.insert(instant_of(board));
            stage.ties.push_back({a, b, static_cast<int>(shared.size())});
        }

    // Without a floor the first rig is assumed level, so that y is up for the virtual camera.
    StereoCalibration level = rigs.front().calibration;
    assume_place(level);
    Pose world_from_start = level.world_from_left * bundle.rigs.front().world_from_rig.inverse();
    if (floor) {
        const int on_floor = find_floor(start, stage, *floor, used_boards);
        const int body = stage.placements[static_cast<std::size_t>(on_floor)].body;
        const int board = start.bodies[static_cast<std::size_t>(body)].boards.front();
        world_from_start =
            world_from_floor_board(boards.boards[static_cast<std::size_t>(board)]) *
            bundle.boards[static_cast<std::size_t>(on_floor)].world_from_board.inverse();
        stage.has_floor = true;
    }
    const BundleUncertainty uncertainty = bundle_uncertainty(bundle);
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        StageCalibration::Rig rig;
        rig.name = rigs[i].name;
        rig.calibration = rigs[i].calibration;
        rig.calibration.world_from_left = world_from_start * bundle.rigs[i].world_from_rig;
        rig.calibration.place_is_assumed = false;
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
        std::set<long long> seen_at;
        for (const auto& [board, seen_by] : rigs_of_board)
            if (seen_by.contains(i)) seen_at.insert(instant_of(board));
        rig.instants = static_cast<int>(seen_at.size());
        if (rig.instants == 0)
            fail(
                "every picture of rig {} contradicts the other rigs: its calibration is not its "
                "own, its left and right pictures are swapped or turned, or it was moved",
                rig.name);
        stage.rigs.push_back(rig);
    }
    const int shown = start.bodies.front().boards.front();
    stage.next_picture = most_helpful_picture(
        bundle, uncertainty, boards.boards[static_cast<std::size_t>(shown)], shown);
    advise(stage);
    for (StageCalibration::Body& body : stage.bodies) {
        if (body.boards.size() < 2) continue;
        for (const int board : body.boards) {
            const auto k = static_cast<std::size_t>(board);
            body.body_from_board.push_back(bundle.faces[k].board_from_face);
            body.translation_sigma_m.push_back(uncertainty.faces[k].translation_m.norm());
        }
    }
    stage.bundle = std::move(bundle);
    return stage;
}

}  // namespace vantage
