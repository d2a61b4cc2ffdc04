#include "host_app/desk/desk_screen.h"

namespace vantage {
namespace {

constexpr float usual_aspect = 9.0f / 16;

float aspect_of(const Texture* picture) {
    return picture
               ? static_cast<float>(picture->height_px()) / static_cast<float>(picture->width_px())
               : usual_aspect;
}

}  // namespace

DrawnDesk draw_desk(const DeskState& state, const DeskSwitches& switches, const UiFonts& fonts) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Pen pen(fonts);
    pen.fill({0, 0, size.x, size.y}, palette::ground);
    const float aspect = aspect_of(state.picture);
    DeskLayout layout;
    layout.programme = {0, 0, size.x, size.y};
    if (switches.panels)
        layout = desk_layout(size.x, size.y, pen.em(), static_cast<int>(state.rigs.size()), aspect,
                             !state.replay.clips.empty());
    DrawnDesk drawn;
    drawn.picture = layout.programme.fitted(aspect);
    pen.fill(layout.programme, palette::black);
    if (state.picture) pen.image(drawn.picture, *state.picture);
    if (switches.panels) {
        draw_status(pen, layout.status, state);
        draw_shots(pen, layout.shots, state, drawn.spots);
        draw_clips(pen, layout.clips, state, drawn.spots);
        draw_side(pen, layout.side, state, drawn.spots);
        draw_time_line(pen, layout.time_line, state, drawn.spots);
        draw_multiview(pen, layout.rigs, layout.rig_rows, state);
    }
    drawn.has_overlay = switches.help || state.wheel_map;
    if (state.wheel_map) draw_wheel_map(pen, size.x, size.y, *state.wheel_map, drawn.spots);
    if (switches.help) draw_help(pen, size.x, size.y);
    return drawn;
}

}  // namespace vantage
