#pragma once

namespace vantage {

/// Number of shots that the desk shows, one for each number key.
constexpr int shot_places = 9;

/// A rectangle in the window, in pixels from the upper left corner.
struct DeskRect {
    float left = 0, top = 0, width = 0, height = 0;

    float right() const { return left + width; }
    float bottom() const { return top + height; }
    bool is_empty() const { return width < 1 || height < 1; }
    bool contains(float x, float y) const {
        return x >= left && x < right() && y >= top && y < bottom();
    }
    DeskRect shrunk(float by) const {
        return {left + by, top + by, width - 2 * by, height - 2 * by};
    }
    /// The largest centred rectangle in it with this aspect (height divided by width).
    DeskRect fitted(float aspect) const;
};

/// Returns the font height for a window of this size: a fixed share of the window, but never too
/// small to read. `content_scale` is the display's scale: 2 on a display of twice the usual
/// density.
float letter_height_px(float width_px, float height_px, float content_scale);

/// The rectangles of the desk's parts. A part that a small window has no room for is empty.
struct DeskLayout {
    DeskRect status, programme, preview, shots, clips, side, time_line, rigs;
    int rig_rows = 1;
};

/// Lays out the desk. `em_px` is the font height, `rigs` the number of rigs in the row, `aspect`
/// height divided by width of the programme's picture. With `has_clips` there is a column for
/// clips. With `has_preview` the preview's picture stands beside the programme's, each below its
/// name.
DeskLayout desk_layout(float width_px, float height_px, float em_px, int rigs, float aspect,
                       bool has_clips = false, bool has_preview = false);
/// Returns the number of rows in which the rigs' cells are largest when they fill a whole window.
int best_rig_rows(float width_px, float height_px, float em_px, int rigs);
/// Lays out the pictures alone, without panels.
DeskLayout pictures_alone(float width_px, float height_px, bool has_preview);

}  // namespace vantage
