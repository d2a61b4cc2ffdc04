#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_app/desk/desk_arrangement.h"
#include "host_app/desk/desk_state.h"
#include "host_app/desk/windows/pen.h"

namespace vantage {

/// The parts of the desk that react to a mouse click.
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
    std::vector<Numbered> wheel_controls;  ///< of a wheel's map, which covers the rest
    std::optional<Time> time;
    DeskRect live;     ///< the button that goes back to live; empty: there is none
    DeskRect outside;  ///< the 3-D view of the stage; empty: it is not shown
};

/// The positions of the desk's parts as they were drawn.
struct DrawnDesk {
    DeskRect picture;  ///< of the programme; only an overlay covers it
    std::optional<DeskRect> preview = {};
    bool has_overlay = false;
    int help_pages = 0;  ///< 0: the help is not shown
    DeskSpots spots = {};

    /// The picture of the camera that operator input flies.
    const DeskRect& in_hand() const { return preview ? *preview : picture; }
};

/// Draws the whole desk in the current ImGui frame.
DrawnDesk draw_desk(const DeskState& state, const DeskSwitches& switches, const UiFonts& fonts);

/// Height divided by width; 9/16 without a picture.
float aspect_of(const Texture* picture);

// These draw the other parts of the desk, each within its rectangle.
void draw_status(const Pen& pen, const DeskRect& rect, const DeskState& state);
void draw_multiview(const Pen& pen, const DeskRect& rect, int rows, const DeskState& state);
void draw_stage_plan(const Pen& pen, const DeskRect& rect, const DeskState& state);
void draw_stage_outside(const Pen& pen, const DeskRect& rect, const DeskState& state,
                        const OutsideEye& eye);
/// Draws the message that replaces the plan while the stage is unknown.
void draw_unknown_stage(const Pen& pen, const DeskRect& rect);
void draw_side(const Pen& pen, const DeskRect& rect, const DeskState& state,
               const DeskSwitches& switches, DeskSpots& spots);
void draw_time_line(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots);
void draw_clips(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots);
void draw_shots(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots);
/// Draws a wheel's map in the middle of the window, over everything else.
void draw_wheel_map(const Pen& pen, float width_px, float height_px, const DeskWheel& wheel,
                    DeskSpots& spots);
/// Draws a page of the help, from 1 on, and returns the number of pages.
int draw_help(const Pen& pen, float width_px, float height_px, int page);

}  // namespace vantage
