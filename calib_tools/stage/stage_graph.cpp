#include "calib_tools/stage/stage_graph.h"

#include <algorithm>
#include <limits>
#include <set>

#include "common/base/error.h"

namespace vantage {
namespace {

using Key = std::tuple<std::size_t, long long, int>;  // rig, frame set, body

const BoardCorners& seen_at(const std::map<long long, BoardCorners>& series, long long instant) {
    static const BoardCorners nothing;
    const auto found = series.find(instant);
    return found == series.end() ? nothing : found->second;
}

/// Mean distance of the corners from their prediction by the pose; a corner counts at most 50 px.
double mean_miss_px(const CameraModel& camera, const Pose& camera_from_body,
                    const BoardCorners& corners, const StageStart& start) {
    constexpr double most_px = 50;
    double sum = 0;
    for (const BoardCorner& corner : corners) {
        const auto pixel = camera.project(
            camera_from_body *
            (start.body_from_board[static_cast<std::size_t>(corner.board)] * corner.board_m));
        sum += pixel ? std::min(most_px, (*pixel - corner.pixel).norm()) : most_px;
    }
    return sum / std::max<double>(1, static_cast<double>(corners.size()));
}

/// Computes rig_from_body from all corners of the body in both cameras.
std::optional<Pose> pose_body(const StageRig& rig, const BoardCorners& left,
                              const BoardCorners& right, const StageStart& start) {
    const StereoCalibration& c = rig.calibration;
    const Pose left_from_right = c.right_from_left.inverse();
    std::optional<Pose> best;
    double least = std::numeric_limits<double>::max();
    for (const bool is_left : {true, false}) {
        const BoardCorners& corners = is_left ? left : right;
        std::set<int> boards;
        for (const BoardCorner& corner : corners) boards.insert(corner.board);
        for (const int board : boards) {
            const BoardCorners of_board =
                corners_of(corners, [&](int each) { return each == board; });
            for (const Pose& camera_from_board :
                 board_pose_candidates(is_left ? c.left : c.right, of_board)) {
                const Pose rig_from_body =
                    (is_left ? camera_from_board : left_from_right * camera_from_board) *
                    start.body_from_board[static_cast<std::size_t>(board)].inverse();
                const double miss =
                    mean_miss_px(c.left, rig_from_body, left, start) +
                    mean_miss_px(c.right, c.right_from_left * rig_from_body, right, start);
                if (miss < least) {
                    least = miss;
                    best = rig_from_body;
                }
            }
        }
    }
    return best;
}

void pose_bodies(const std::vector<StageRig>& rigs, StageStart& start) {
    start.rig_from_body.clear();
    for (std::size_t r = 0; r < rigs.size(); ++r) {
        std::set<std::pair<long long, int>> seen;
        for (const auto* series : {&rigs[r].left, &rigs[r].right})
            for (const auto& [instant, corners] : *series)
                for (const BoardCorner& corner : corners)
                    seen.emplace(instant,
                                 start.body_of_board[static_cast<std::size_t>(corner.board)]);
        for (const auto& [instant, body] : seen) {
            const auto wanted = [&, body = body](int board) {
                return start.body_of_board[static_cast<std::size_t>(board)] == body;
            };
            if (const auto pose =
                    pose_body(rigs[r], corners_of(seen_at(rigs[r].left, instant), wanted),
                              corners_of(seen_at(rigs[r].right, instant), wanted), start))
                start.rig_from_body[{r, instant, body}] = *pose;
        }
    }
}

/// Joins bodies that belong together but whose relative pose is not known yet. It uses
/// body_from_other of every frame set in which one rig, or two placed rigs, saw both.
bool join_bodies(const std::vector<int>& piece_of_body, const std::vector<bool>& standing,
                 StageStart& start) {
    std::map<std::pair<int, int>, std::vector<Pose>> candidates;
    for (const auto& [key_a, rig_a_from_a] : start.rig_from_body)
        for (const auto& [key_b, rig_b_from_b] : start.rig_from_body) {
            const auto& [rig_a, instant_a, a] = key_a;
            const auto& [rig_b, instant_b, b] = key_b;
            if (instant_a != instant_b || a >= b ||
                piece_of_body[static_cast<std::size_t>(a)] !=
                    piece_of_body[static_cast<std::size_t>(b)])
                continue;
            if (rig_a != rig_b && !(standing[rig_a] && standing[rig_b])) continue;
            candidates[{a, b}].push_back((start.world_from_rig[rig_a] * rig_a_from_a).inverse() *
                                         start.world_from_rig[rig_b] * rig_b_from_b);
        }
    const auto most = std::max_element(
        candidates.begin(), candidates.end(),
        [](const auto& x, const auto& y) { return x.second.size() < y.second.size(); });
    if (most == candidates.end()) return false;
    const auto [a, b] = most->first;
    const Pose a_from_b = middle_pose(most->second).right_from_left;
    StageStart::Body& body = start.bodies[static_cast<std::size_t>(a)];
    for (const int board : start.bodies[static_cast<std::size_t>(b)].boards) {
        const auto i = static_cast<std::size_t>(board);
        start.body_from_board[i] = a_from_b * start.body_from_board[i];
        start.body_of_board[i] = a;
        body.boards.push_back(board);
    }
    start.bodies[static_cast<std::size_t>(b)].boards.clear();
    return true;
}

/// Places the rig with the most common sightings with a placed rig.
bool place_rig(std::vector<bool>& standing, StageStart& start) {
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Pose>> candidates;
    for (const auto& [key_a, rig_a_from_body] : start.rig_from_body)
        for (const auto& [key_b, rig_b_from_body] : start.rig_from_body) {
            const auto& [a, instant_a, body_a] = key_a;
            const auto& [b, instant_b, body_b] = key_b;
            if (instant_a == instant_b && body_a == body_b && standing[a] && !standing[b])
                candidates[{a, b}].push_back(rig_a_from_body * rig_b_from_body.inverse());
        }
    const auto most = std::max_element(
        candidates.begin(), candidates.end(),
        [](const auto& x, const auto& y) { return x.second.size() < y.second.size(); });
    if (most == candidates.end()) return false;
    const auto [a, b] = most->first;
    start.world_from_rig[b] = start.world_from_rig[a] * middle_pose(most->second).right_from_left;
    standing[b] = true;
    return true;
}

void require_all_standing(const std::vector<StageRig>& rigs, const std::vector<bool>& standing) {
    std::string here, lost;
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        std::string& names = standing[i] ? here : lost;
        names += (names.empty() ? "" : ", ") + rigs[i].name;
    }
    if (!lost.empty())
        fail(
            "no picture shows the board to {} and to {} at the same instant: hold the board where "
            "one of the first and one of the second see it, and take pictures there",
            lost, here);
}

/// Removes bodies without boards; the first of the boards with the most sightings defines a body's
/// frame.
void tidy_bodies(const std::vector<StageRig>& rigs, const CalibrationBoards& boards,
                 StageStart& start) {
    std::vector<int> corners(boards.boards.size(), 0);
    for (const StageRig& rig : rigs)
        for (const auto* series : {&rig.left, &rig.right})
            for (const auto& [instant, seen] : *series)
                for (const BoardCorner& corner : seen)
                    ++corners[static_cast<std::size_t>(corner.board)];
    std::erase_if(start.bodies, [](const StageStart::Body& body) { return body.boards.empty(); });
    for (std::size_t i = 0; i < start.bodies.size(); ++i) {
        StageStart::Body& body = start.bodies[i];
        const auto seen_most =
            std::max_element(body.boards.begin(), body.boards.end(), [&](int a, int b) {
                return corners[static_cast<std::size_t>(a)] < corners[static_cast<std::size_t>(b)];
            });
        std::iter_swap(body.boards.begin(), seen_most);
        const Pose frame =
            start.body_from_board[static_cast<std::size_t>(body.boards.front())].inverse();
        for (const int board : body.boards) {
            const auto k = static_cast<std::size_t>(board);
            start.body_of_board[k] = static_cast<int>(i);
            start.body_from_board[k] = frame * start.body_from_board[k];
        }
        const BoardBody& whole =
            boards.bodies[static_cast<std::size_t>(boards.body_of(body.boards.front()))];
        // A single face keeps its own name.
        body.name = body.boards.size() > 1 ? whole.name : boards.board_name(body.boards.front());
    }
}

}  // namespace

StageStart start_stage(const std::vector<StageRig>& rigs, const CalibrationBoards& boards) {
    StageStart start;
    start.world_from_rig.assign(rigs.size(), Pose::Identity());
    start.body_from_board.assign(boards.boards.size(), Pose::Identity());
    std::vector<int> piece_of_body;
    for (int i = 0; i < static_cast<int>(boards.boards.size()); ++i) {
        start.bodies.push_back({"", {i}});
        start.body_of_board.push_back(i);
        piece_of_body.push_back(boards.body_of(i));
    }
    std::vector<bool> standing(rigs.size(), false);
    standing[0] = true;
    pose_bodies(rigs, start);
    for (std::size_t i = 0; i < rigs.size(); ++i)
        if (std::none_of(start.rig_from_body.begin(), start.rig_from_body.end(),
                         [&](const auto& seen) { return std::get<0>(seen.first) == i; }))
            fail("rig {} saw the board in none of its pictures", rigs[i].name);
    for (;;) {
        if (join_bodies(piece_of_body, standing, start))
            pose_bodies(rigs, start);
        else if (!place_rig(standing, start))
            break;
    }
    require_all_standing(rigs, standing);
    tidy_bodies(rigs, boards, start);
    pose_bodies(rigs, start);
    return start;
}

}  // namespace vantage
