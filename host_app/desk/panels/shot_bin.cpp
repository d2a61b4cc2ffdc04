#include <fmt/format.h>

#include "host_app/desk/panels/bin_cell.h"
#include "host_app/desk/panels/desk_parts.h"
#include "host_app/desk/panels/shot_places.h"

namespace vantage {

void draw_shots(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots) {
    if (rect.is_empty()) return;
    const float gap = 0.25f * pen.em();
    const float height = rect.height / shot_places - gap;
    for (int number = 1; number <= shot_places; ++number) {
        const auto at = static_cast<std::size_t>(number - 1);
        const DeskShot shot = at < state.shots.size() ? state.shots[at] : DeskShot{};
        const DeskRect place{rect.left, rect.top + static_cast<float>(at) * (height + gap),
                             rect.width, height};
        const Clipping clipping(pen, place);
        draw_bin_cell(pen, place, shot.picture, fmt::format("{} {}", number, shot.name),
                      shot.is_kept ? palette::text : palette::dim);
        if (shot.is_kept) pen.outline(place, palette::accent);
        if (!shot.name.empty()) spots.shots.push_back({place, number});
    }
}

}  // namespace vantage
