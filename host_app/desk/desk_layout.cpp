#include "host_app/desk/desk_layout.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

// Lengths in ems, the font height.
constexpr float cells_gap = 0.4f, status_height = 2.5f, time_line_height = 2.9f, side_width = 23;
/// Smallest window with a side panel and with a row of rigs. A smaller one has room only for the
/// programme, the status bar and the time line.
constexpr float min_width_with_side = 62, min_height_with_rigs = 32;

/// Height of the caption of a rig's cell, and the cell's width in heights of its colour picture.
constexpr float cell_caption_height = 1.6f, cell_aspect = 2.2f;
/// Largest and smallest share of the window's height for the rigs' pictures.
constexpr float max_rigs_height = 0.19f, min_rigs_height = 0.1f;

float rig_picture_height(float width, float height, float rigs, float rows) {
    const float columns = std::ceil(rigs / rows);
    return std::min((width / columns - cells_gap) / cell_aspect, max_rigs_height * height / rows);
}

/// The programme's share of the width beside the preview, the preview's share of the height above
/// the side panel, and the height of a picture's name.
constexpr float programme_share = 0.6f, preview_share = 0.64f, name_height = 1.5f;

/// Splits the programme's rectangle. The preview is on the left, as on a vision mixer.
void halve(DeskLayout& layout, float between) {
    DeskRect& programme = layout.programme;
    layout.preview = programme;
    layout.preview.width = programme.width = 0.5f * (programme.width - between);
    programme.left += programme.width + between;
}

}  // namespace

DeskRect DeskRect::fitted(float aspect) const {
    const float fitted_width = std::min(width, height / aspect);
    const float fitted_height = fitted_width * aspect;
    return {left + 0.5f * (width - fitted_width), top + 0.5f * (height - fitted_height),
            fitted_width, fitted_height};
}

float letter_height_px(float width_px, float height_px, float content_scale) {
    // A window has 54 lines of text, but text below 9 px cannot be read.
    constexpr float rows = 54, columns = 96, min_px = 9;
    return std::round(
        std::max(std::min(height_px / rows, width_px / columns), min_px * content_scale));
}

DeskLayout desk_layout(float width_px, float height_px, float em_px, int rigs, float aspect,
                       bool has_clips, bool has_preview) {
    const float width = width_px / em_px, height = height_px / em_px;
    DeskLayout layout;
    layout.status = {0, 0, width, status_height};
    float bottom = height;
    if (rigs > 0 && height >= min_height_with_rigs) {
        const auto count = static_cast<float>(rigs);
        float rows = 1;
        while (rig_picture_height(width, height, count, rows) < min_rigs_height * height / rows &&
               rows < 3)
            ++rows;
        layout.rig_rows = static_cast<int>(rows);
        const float all =
            rows * (rig_picture_height(width, height, count, rows) + cell_caption_height);
        layout.rigs = {0, bottom - all, width, all};
        bottom = layout.rigs.top - cells_gap;
    }
    layout.time_line = {cells_gap, bottom - time_line_height, width - 2 * cells_gap,
                        time_line_height};
    bottom = layout.time_line.top - cells_gap;
    const float top = status_height + cells_gap;
    const float middle = std::max(bottom - top, 1.0f);
    float right = width - cells_gap;
    if (width >= min_width_with_side) {
        const float shot_height = middle / shot_places - cells_gap;
        const float shot_width = std::min(shot_height / aspect, 0.11f * width);
        const float bins = has_clips ? 2 : 1;
        // The side panel takes the width that the picture leaves.
        const float both_width = right - bins * (shot_width + cells_gap) - 2 * cells_gap;
        const float picture_width =
            has_preview ? std::min((middle - name_height) / aspect, programme_share * both_width)
                        : std::min(middle / aspect, both_width - side_width);
        const float side_left = 2 * cells_gap + picture_width + bins * (shot_width + cells_gap);
        layout.shots = {2 * cells_gap + picture_width, top, shot_width, middle};
        if (has_clips) layout.clips = {layout.shots.right() + cells_gap, top, shot_width, middle};
        layout.side = {side_left, top, right - side_left, middle};
        if (has_preview) {
            layout.preview = layout.side;
            layout.preview.height =
                std::min(name_height + layout.side.width * aspect, preview_share * middle);
            layout.side.top = layout.preview.bottom() + cells_gap;
            layout.side.height -= layout.preview.height + cells_gap;
        }
        right = cells_gap + picture_width;
    }
    layout.programme = {cells_gap, top, right - cells_gap, middle};
    if (has_preview && layout.side.is_empty()) halve(layout, cells_gap);
    for (DeskRect* part : {&layout.status, &layout.programme, &layout.preview, &layout.shots,
                           &layout.clips, &layout.side, &layout.time_line, &layout.rigs})
        *part = {part->left * em_px, part->top * em_px, part->width * em_px, part->height * em_px};
    return layout;
}

int best_rig_rows(float width_px, float height_px, float em_px, int rigs) {
    int best = 1;
    float largest = 0;
    for (int rows = 1; rows <= rigs; ++rows) {
        const float columns = std::ceil(static_cast<float>(rigs) / static_cast<float>(rows));
        const float height =
            std::min(width_px / columns / cell_aspect,
                     height_px / static_cast<float>(rows) - cell_caption_height * em_px);
        if (height <= largest) continue;
        largest = height;
        best = rows;
    }
    return best;
}

DeskLayout pictures_alone(float width_px, float height_px, bool has_preview) {
    DeskLayout layout;
    layout.programme = {0, 0, width_px, height_px};
    if (has_preview) halve(layout, 0);
    return layout;
}

}  // namespace vantage
