#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "calib_tools/live/board_film.h"
#include "calib_tools/rig/camera_solver.h"
#include "calib_tools/rig/guidance.h"
#include "calib_tools/stage/repeated_sightings.h"
#include "calib_tools/stage/stage_calibration.h"
#include "common/base/error.h"

namespace vantage {
namespace {

/// Smallest number of images for a lens estimate that gives the tilt of a board.
constexpr std::size_t fewest_for_lens = 4;

std::string fault_of(const SeenPicture& picture) {
    return picture.name() + " " + picture.sighting.reason;
}

std::vector<std::string> missing_for_camera(const std::vector<SeenPicture>& pictures,
                                            const std::string& name) {
    CameraViews views;
    for (const SeenPicture& p : pictures) {
        views.width_px = p.width_px;
        views.height_px = p.height_px;
        views.instants.push_back(p.sighting.corners);
    }
    if (views.instants.size() < fewest_for_lens)
        return {fmt::format("{} more of the {} camera before its lens can be judged",
                            fewest_for_lens - views.instants.size(), name)};
    const std::optional<Bundle> solved = solve_camera(views, lens_family("radial1"));
    if (!solved)
        return {fmt::format("pictures of the {} camera with the board tilted by 30 degrees", name)};
    return missing_pictures(*solved, 0, name);
}

}  // namespace

std::string all_see_board(const std::vector<SeenPicture>& pictures) {
    for (const SeenPicture& picture : pictures)
        if (!picture.sighting.found()) return fault_of(picture);
    return {};
}

FilmAdvice lens_advice(std::vector<std::string> camera_names) {
    return [names = std::move(camera_names)](const BoardFilm& film) {
        std::vector<std::string> all;
        for (std::size_t c = 0; c < names.size(); ++c)
            for (std::string& sentence : missing_for_camera(film.pictures[c], names[c]))
                all.push_back(std::move(sentence));
        return all;
    };
}

FilmRule two_rigs_see_board(const CalibrationBoards& boards) {
    return [boards](const std::vector<SeenPicture>& pictures) -> std::string {
        std::map<int, std::set<std::size_t>> rigs_of_body;
        std::size_t most = 0;
        for (std::size_t c = 0; c < pictures.size(); ++c)
            for (const BoardCorner& corner : pictures[c].sighting.corners) {
                std::set<std::size_t>& rigs = rigs_of_body[boards.body_of(corner.board)];
                rigs.insert(c / 2);
                most = std::max(most, rigs.size());
            }
        if (most >= 2) return {};
        for (const SeenPicture& picture : pictures)
            if (!picture.sighting.found() && picture.sighting.reason.starts_with("is blurred"))
                return fault_of(picture);
        return fmt::format("{} sees the board: hold it where two rigs see it",
                           most == 0                 ? "no rig"
                           : rigs_of_body.size() > 1 ? "of every board only one rig"
                                                     : "only one rig");
    };
}

FilmRule floor_first(const CalibrationBoards& boards, std::string floor_board) {
    return [boards, two_rigs_see = two_rigs_see_board(boards), name = std::move(floor_board),
            is_first = true](const std::vector<SeenPicture>& pictures) mutable -> std::string {
        std::string fault = two_rigs_see(pictures);
        if (!fault.empty() || !is_first) return fault;
        std::set<std::string> flat;
        for (const SeenPicture& picture : pictures)
            for (const BoardCorner& corner : picture.sighting.corners) {
                const BoardBody& body =
                    boards.bodies[static_cast<std::size_t>(boards.body_of(corner.board))];
                if (body.boards.size() == 1) flat.insert(body.name);
            }
        if (name.empty() ? flat.size() == 1 : flat.contains(name)) {
            is_first = false;
            return {};
        }
        return name.empty() ? "the first instant has to show the board on the floor and no other "
                              "flat one: lay it there, or name it (--floor-board)"
                            : fmt::format("the first instant has to show {} on the floor", name);
    };
}

FilmAdvice tie_advice(const CalibrationBoards& boards, std::vector<std::string> rig_names) {
    return [boards, names = std::move(rig_names)](const BoardFilm& film) {
        const std::size_t count = names.size();
        struct Tie {
            int shared;
            std::size_t a, b;
        };
        std::vector<Tie> ties;
        // Counts like the calibration: a board at rest counts once, and two rigs have to see the
        // same board.
        std::vector<StageRig> rigs(count);
        for (std::size_t k = 0; k < film.pulses.size(); ++k)
            for (std::size_t c = 0; c < 2 * count; ++c)
                if (film.pictures[c][k].sighting.found())
                    (c % 2 == 0 ? rigs[c / 2].left : rigs[c / 2].right)[static_cast<long long>(k)] =
                        film.pictures[c][k].sighting.corners;
        rigs = without_repeats(std::move(rigs), std::nullopt);
        std::vector<std::map<long long, std::set<int>>> bodies(count);
        for (std::size_t rig = 0; rig < count; ++rig)
            for (const auto* series : {&rigs[rig].left, &rigs[rig].right})
                for (const auto& [instant, corners] : *series)
                    for (const BoardCorner& corner : corners)
                        bodies[rig][instant].insert(boards.body_of(corner.board));
        const auto share = [&](std::size_t a, std::size_t b, long long instant) {
            return std::any_of(bodies[a][instant].begin(), bodies[a][instant].end(),
                               [&](int body) { return bodies[b][instant].contains(body); });
        };
        for (std::size_t a = 0; a < count; ++a)
            for (std::size_t b = a + 1; b < count; ++b) {
                Tie tie{0, a, b};
                for (std::size_t k = 0; k < film.pulses.size(); ++k)
                    tie.shared += share(a, b, static_cast<long long>(k)) ? 1 : 0;
                ties.push_back(tie);
            }
        // Maximum spanning tree of the connections (Kruskal); its weak connections are reported.
        std::stable_sort(ties.begin(), ties.end(),
                         [](const Tie& x, const Tie& y) { return x.shared > y.shared; });
        std::vector<std::size_t> group(count);
        std::iota(group.begin(), group.end(), 0u);
        std::vector<std::string> all;
        for (const Tie& tie : ties) {
            if (group[tie.a] == group[tie.b]) continue;
            std::replace(group.begin(), group.end(), std::size_t{group[tie.b]},
                         std::size_t{group[tie.a]});
            if (tie.shared == 0)
                all.push_back(
                    fmt::format("the board before rig {} and a neighbour of it", names[tie.b]));
            else if (tie.shared < StageCalibration::few_shared)
                all.push_back(fmt::format("the board where rigs {} and {} both see it ({} of {})",
                                          names[tie.a], names[tie.b], tie.shared,
                                          StageCalibration::few_shared));
        }
        return all;
    };
}

}  // namespace vantage
