#pragma once

namespace vantage {

/// A part of the window, in its pixels from the upper left corner.
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
    /// The largest part in its middle with this height by width.
    DeskRect fitted(float aspect) const;
};

/// The height of letters in a window of this size: the same share of every one, but never too small
/// to be read. `content_scale` is the display's: 2 where its pixels are twice as dense as usual.
float letter_height_px(float width_px, float height_px, float content_scale);

/// Where the parts of the desk stand. What a small window has no room for is empty.
struct DeskLayout {
    DeskRect status, programme, preview, shots, clips, side, time_line, rigs;
    int rig_rows = 1;
};

/// `em_px`: height of letters; `rigs`: how many are to be shown; `aspect`: height by width of the
/// programme's picture; `has_clips`: there are clips to be shown; `has_preview`: there is a camera
/// on preview, whose picture stands beside the programme's, each with room for its name over it.
DeskLayout desk_layout(float width_px, float height_px, float em_px, int rigs, float aspect,
                       bool has_clips = false, bool has_preview = false);
/// In how many rows the rigs' cells are largest, where they have the whole window.
int best_rig_rows(float width_px, float height_px, float em_px, int rigs);
/// Nothing but the pictures.
DeskLayout pictures_alone(float width_px, float height_px, bool has_preview);

}  // namespace vantage
