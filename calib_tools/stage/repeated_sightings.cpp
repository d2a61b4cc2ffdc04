#include "calib_tools/stage/repeated_sightings.h"

#include <map>
#include <set>
#include <utility>

#include "calib_tools/stage/stage_graph.h"

namespace vantage {
namespace {

/// Largest movement of a board at rest in the image; noise moves its corners far less.
constexpr double still_px = 0.5;

/// Corners of one board in all cameras of one frame set; the key is 2 * rig, + 1 for a right
/// camera.
using BoardInstant = std::map<std::size_t, BoardCorners>;

bool stands_still(const BoardCorners& now, const BoardCorners& before) {
    double way_px = 0;
    std::size_t shared = 0;
    for (auto i = now.begin(), k = before.begin(); i != now.end() && k != before.end();) {
        if (i->id == k->id) {
            way_px += (i->pixel - k->pixel).norm();
            ++shared;
        }
        const int id = i->id;
        if (id <= k->id) ++i;
        if (k->id <= id) ++k;
    }
    // Corners that were hidden in the earlier frame set are new.
    return shared == now.size() && way_px < still_px * static_cast<double>(shared);
}

bool repeats(const BoardInstant& now, const BoardInstant& before) {
    for (const auto& [camera, corners] : now) {
        const auto then = before.find(camera);
        if (then == before.end() || !stands_still(corners, then->second)) return false;
    }
    return true;
}

}  // namespace

std::vector<StageRig> without_repeats(std::vector<StageRig> rigs, std::optional<long long> kept) {
    std::map<int, std::map<long long, BoardInstant>> seen;
    const auto series_of = [&](std::size_t camera) -> std::map<long long, BoardCorners>& {
        return camera % 2 == 0 ? rigs[camera / 2].left : rigs[camera / 2].right;
    };
    for (std::size_t camera = 0; camera < 2 * rigs.size(); ++camera)
        for (const auto& [instant, corners] : series_of(camera))
            for (const BoardCorner& corner : corners)
                seen[corner.board][instant][camera].push_back(corner);
    for (const auto& [board, instants] : seen) {
        std::vector<const BoardInstant*> new_ones;
        if (kept && instants.contains(*kept)) new_ones.push_back(&instants.at(*kept));
        for (const auto& [instant, now] : instants) {
            if (kept && instant == *kept) continue;
            bool repeated = false;
            for (const BoardInstant* before : new_ones)
                repeated = repeated || repeats(now, *before);
            if (!repeated) {
                new_ones.push_back(&now);
                continue;
            }
            for (const auto& [camera, corners] : now) {
                auto& series = series_of(camera);
                BoardCorners& all = series.at(instant);
                all = corners_of(all, [board = board](int each) { return each != board; });
                if (all.empty()) series.erase(instant);
            }
        }
    }
    return rigs;
}

}  // namespace vantage
