#include "host_app/desk/panels/desk_parts.h"

namespace vantage {

DrawnDesk draw_desk(const DeskState& state, const DeskSwitches& switches, const UiFonts& fonts) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Pen pen(fonts);
    pen.fill({0, 0, size.x, size.y}, palette::ground);
    const bool has_preview = state.preview.has_value();
    const DeskLayout layout =
        switches.panels
            ? desk_layout(
                  size.x, size.y, pen.em(),
                  switches.rigs && !switches.rigs_apart ? static_cast<int>(state.rigs.size()) : 0,
                  aspect_of(state.picture), !state.replay.clips.empty(), has_preview)
            : pictures_alone(size.x, size.y, has_preview);
    DrawnDesk drawn;
    draw_monitors(pen, layout, state, drawn);
    if (switches.panels) {
        draw_status(pen, layout.status, state);
        draw_shots(pen, layout.shots, state, drawn.spots);
        draw_clips(pen, layout.clips, state, drawn.spots);
        draw_side(pen, layout.side, state, switches, drawn.spots);
        draw_time_line(pen, layout.time_line, state, drawn.spots);
        draw_multiview(pen, layout.rigs, layout.rig_rows, state);
    }
    drawn.has_overlay = switches.help > 0 || state.wheel_map;
    if (state.wheel_map) draw_wheel_map(pen, size.x, size.y, *state.wheel_map, drawn.spots);
    if (switches.help > 0) drawn.help_pages = draw_help(pen, size.x, size.y, switches.help);
    return drawn;
}

}  // namespace vantage
