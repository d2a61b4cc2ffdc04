#include <algorithm>

#include <fmt/format.h>

#include "host_app/desk/desk_parts.h"
#include "host_app/desk/shot_places.h"

namespace vantage {

void draw_shots(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots) {
    if (rect.is_empty()) return;
    const float em = pen.em(), gap = 0.25f * em;
    const float height = rect.height / shot_places - gap;
    for (int number = 1; number <= shot_places; ++number) {
        const auto at = static_cast<std::size_t>(number - 1);
        const DeskShot shot = at < state.shots.size() ? state.shots[at] : DeskShot{};
        const DeskRect place{rect.left, rect.top + static_cast<float>(at) * (height + gap),
                             rect.width, height};
        const Clip clip(pen, place);
        pen.fill(place, palette::panel);
        if (shot.picture) {
            const float aspect = static_cast<float>(shot.picture->height_px()) /
                                 static_cast<float>(shot.picture->width_px());
            pen.image(place.fitted(aspect), *shot.picture);
        }
        const std::string words = fmt::format("{} {}", number, shot.name);
        const DeskRect label{place.left, place.bottom() - 1.2f * em,
                             std::min(pen.width_of(words, true) + 0.5f * em, place.width),
                             1.2f * em};
        if (shot.picture) pen.fill(label, palette::panel);
        pen.text_until(place.right(), label.left + 0.25f * em, label.top + 0.1f * em,
                       shot.is_kept ? palette::text : palette::dim, words, true);
        if (shot.is_kept) pen.outline(place, palette::accent);
        if (!shot.name.empty()) spots.shots.push_back({place, number});
    }
}

}  // namespace vantage
