#include "host_app/desk/panels/bin_cell.h"

#include <algorithm>

namespace vantage {

void draw_bin_cell(const Pen& pen, const DeskRect& place, const Texture* picture,
                   const std::string& words, const ImVec4& colour) {
    const float em = pen.em();
    pen.fill(place, palette::panel);
    if (picture)
        pen.image(place.fitted(static_cast<float>(picture->height_px()) /
                               static_cast<float>(picture->width_px())),
                  *picture);
    const DeskRect label{place.left, place.bottom() - 1.2f * em,
                         std::min(pen.width_of(words, true) + 0.5f * em, place.width), 1.2f * em};
    if (picture) pen.fill(label, palette::panel);
    pen.text_until(place.right(), label.left + 0.25f * em, label.top + 0.1f * em, colour, words,
                   true);
}

}  // namespace vantage
