#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_app/desk/desk_layout.h"
#include "host_app/desk/desk_state.h"
#include "host_app/desk/desk_switches.h"
#include "host_app/desk/panels/outside_view.h"
#include "host_app/desk/windows/pen.h"

namespace vantage {

/// What the mouse can press on the desk.
struct DeskSpots {
    struct Numbered {
        DeskRect rect;
        int number = 1;  ///< from 1 on
    };
    struct Time {
        DeskRect rect;
        DeskTime time;
    };
    std::vector<Numbered> shots, outputs, clips, entries;
    /// Of a wheel's map, which lies over all else: by the control's place in it.
    std::vector<Numbered> wheel_controls;
    std::optional<Time> time;
    DeskRect live;     ///< empty: there is no live to go back to
    DeskRect outside;  ///< the stage from outside; empty: it is not shown
};

/// Where the desk was drawn.
struct DrawnDesk {
    DeskRect picture;  ///< of the programme, with nothing over it unless there is an overlay
    std::optional<DeskRect> preview = {};  ///< its picture; nothing: there is none
    bool has_overlay = false;
    int help_pages = 0;  ///< 0: the help is not shown
    DeskSpots spots = {};

    /// The picture of the camera that hands fly.
    const DeskRect& in_hand() const { return preview ? *preview : picture; }
};

/// Height by width.
float aspect_of(const Texture* picture);

/// The pictures of programme and preview.
void draw_monitors(const Pen& pen, const DeskLayout& layout, const DeskState& state,
                   DrawnDesk& drawn);
// The other parts of the desk, each within its rectangle.
void draw_status(const Pen& pen, const DeskRect& rect, const DeskState& state);
void draw_multiview(const Pen& pen, const DeskRect& rect, int rows, const DeskState& state);
void draw_stage_plan(const Pen& pen, const DeskRect& rect, const DeskState& state);
void draw_stage_outside(const Pen& pen, const DeskRect& rect, const DeskState& state,
                        const OutsideEye& eye);
/// In place of either.
void draw_unknown_stage(const Pen& pen, const DeskRect& rect);
void draw_side(const Pen& pen, const DeskRect& rect, const DeskState& state,
               const DeskSwitches& switches, DeskSpots& spots);
void draw_time_line(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots);
void draw_clips(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots);
void draw_shots(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots);
// In the middle of the window, over everything else.
void draw_wheel_map(const Pen& pen, float width_px, float height_px, const DeskWheel& wheel,
                    DeskSpots& spots);
/// Returns how many pages it has, the first of which is 1.
int draw_help(const Pen& pen, float width_px, float height_px, int page);

}  // namespace vantage
