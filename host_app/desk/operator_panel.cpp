#include "host_app/desk/operator_panel.h"

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host_app/control/table/control_command.h"
#include "host_app/desk/ui_renderer.h"

namespace vantage {
namespace {

constexpr ImGuiWindowFlags fixed_panel =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
    ImGuiWindowFlags_NoBringToFrontOnFocus;

/// In ems: between panels, and to the edges.
constexpr float panel_gap = 0.7f, left_panel_width = 25.5f;
/// Of a set that counts as learnt.
constexpr double mostly_known = 0.8;

float em() { return ImGui::GetFontSize(); }

void text(const std::string& words) { ImGui::TextUnformatted(words.c_str()); }
void text(const ImVec4& colour, const std::string& words) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    text(words);
    ImGui::PopStyleColor();
}
void text_right(const std::string& words) {
    const float free = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(words.c_str()).x;
    if (free > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + free);
    text(words);
}
void heading(const UiFonts& fonts, const char* words) {
    ImGui::PushFont(fonts.strong);
    text(palette::dim, words);
    ImGui::PopFont();
}
/// A number in its cell, to the right.
void cell(const std::string& words) {
    ImGui::TableNextColumn();
    text_right(words);
}

/// A filled label such as LIVE.
void badge(const UiFonts& fonts, const char* words, const ImVec4& colour) {
    ImGui::PushFont(fonts.strong);
    const ImVec2 size = ImGui::CalcTextSize(words);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 pad(0.5f * em(), 0.12f * em());
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y - pad.y},
                                              {at.x + size.x + 2 * pad.x, at.y + size.y + pad.y},
                                              ImGui::GetColorU32(colour), 3);
    ImGui::SetCursorScreenPos({at.x + pad.x, at.y});
    text(ImVec4(0.04f, 0.05f, 0.06f, 1), words);
    ImGui::PopFont();
    ImGui::SameLine(0, 1.1f * em());
}

struct StateLook {
    const char* words;
    ImVec4 colour;
};
StateLook look_of(RigState state) {
    switch (state) {
        case RigState::present:
            return {"live", palette::good};
        case RigState::late:
            return {"late", palette::warn};
        case RigState::missed:
            return {"missed", palette::warn};
        case RigState::refused:
            return {"refused", palette::bad};
        case RigState::disconnected:
            break;
    }
    return {"no link", palette::bad};
}

const ImVec4& colour_of(SignalState signal) {
    switch (signal) {
        case SignalState::live:
            return palette::good;
        case SignalState::hold:
            return palette::accent;
        case SignalState::stale:
            return palette::warn;
        case SignalState::no_signal:
            break;
    }
    return palette::bad;
}

void draw_corridor_badge(const Coverage& coverage, const UiFonts& fonts) {
    switch (Corridor::place_of(coverage.share)) {
        case CorridorPlace::inside:
            break;
        case CorridorPlace::edge:
            badge(fonts, "EDGE OF COVERAGE", palette::warn);
            break;
        case CorridorPlace::beyond:
            badge(fonts, "BEYOND COVERAGE", palette::bad);
            break;
    }
}

std::string speed_words(const PanelTime& time) {
    return fmt::format("{}{}", time.speed == 0 ? "HOLD" : fmt::format("PLAY {:g}x", time.speed),
                       time.loops ? " LOOP" : "");
}

/// A line across the screen: what there is of the past, the part between the marks, and where the
/// programme is.
void draw_time_line(const PanelTime& time, float top) {
    const float width = ImGui::GetIO().DisplaySize.x;
    const auto x = [&](double share) { return static_cast<float>(share) * width; };
    ImDrawList& ground = *ImGui::GetBackgroundDrawList();
    const float bottom = top + 0.35f * em();
    ground.AddRectFilled({0, top}, {width, bottom}, ImGui::GetColorU32(palette::line));
    if (time.in || time.out)
        ground.AddRectFilled({x(time.in.value_or(0)), top}, {x(time.out.value_or(1)), bottom},
                             ImGui::GetColorU32(palette::good));
    ground.AddRectFilled({x(time.at) - 3, top}, {x(time.at) + 3, bottom},
                         ImGui::GetColorU32(palette::text));
}

void draw_take_badge(const PanelTake& take, const UiFonts& fonts) {
    if (!take.is_running) {
        badge(fonts, "TAKE ENDED", palette::warn);
        return;
    }
    const auto seconds = static_cast<int>(take.duration_s);
    badge(fonts, fmt::format("REC TAKE {}:{:02}", seconds / 60, seconds % 60).c_str(),
          palette::bad);
}

/// What the rigs cover of the picture and, outside the corridor, what the rest is lost to.
void draw_coverage(const Coverage& coverage) {
    const CorridorPlace place = Corridor::place_of(coverage.share);
    const ImVec4& colour = place == CorridorPlace::inside ? palette::dim
                           : place == CorridorPlace::edge ? palette::warn
                                                          : palette::bad;
    ImGui::PushTextWrapPos(0);
    if (place == CorridorPlace::inside)
        text(colour, fmt::format("the rigs cover {:.0f} %", 100 * coverage.share));
    else
        text(colour, fmt::format("the rigs cover {:.0f} %; most of the rest {}",
                                 100 * coverage.share, words_of(coverage.loss)));
    ImGui::PopTextWrapPos();
}

void draw_picture(const PanelState& state) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImDrawList& ground = *ImGui::GetBackgroundDrawList();
    ground.AddRectFilled({0, 0}, screen, IM_COL32(8, 9, 11, 255));
    if (!state.picture) return;
    const auto width = static_cast<float>(state.picture->width_px());
    const auto height = static_cast<float>(state.picture->height_px());
    const float scale = std::min(screen.x / width, screen.y / height);
    const ImVec2 size(scale * width, scale * height);
    const ImVec2 corner(0.5f * (screen.x - size.x), 0.5f * (screen.y - size.y));
    ground.AddImage(ui_texture(*state.picture), corner, {corner.x + size.x, corner.y + size.y});
}

/// Returns its height.
float draw_top_bar(const PanelState& state, const UiFonts& fonts) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float height = 2.6f * em();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({screen.x, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.9f * em(), 0.65f * em()});
    ImGui::Begin("top bar", nullptr, fixed_panel);
    ImGui::PushFont(fonts.title);
    text("VANTAGE");
    ImGui::PopFont();
    ImGui::SameLine(0, 1.5f * em());
    ImGui::SetCursorPosY(0.8f * em());
    if (state.programme_tally) badge(fonts, "ON AIR", palette::bad);
    if (state.preview_tally) badge(fonts, "PREVIEW", palette::good);
    if (state.waiting)
        badge(fonts, "WAITING FOR RIGS", palette::warn);
    else if (state.behind_s)
        badge(fonts, fmt::format("{:.1f} s BACK", *state.behind_s).c_str(), palette::accent);
    else if (state.time)
        badge(fonts, "FROM A TAKE", palette::accent);
    else
        badge(fonts, title_of(state.signal), colour_of(state.signal));
    if (state.time) badge(fonts, speed_words(*state.time).c_str(), palette::accent);
    if (state.coverage) draw_corridor_badge(*state.coverage, fonts);
    if (state.recording) badge(fonts, "REC FILM", palette::bad);
    if (state.take) draw_take_badge(*state.take, fonts);
    if (!state.waiting) {
        ImGui::PushFont(fonts.strong);
        text(state.timecode);
        ImGui::PopFont();
        ImGui::SameLine(0, 1.1f * em());
        text(palette::dim, fmt::format("pulse {}", state.pulse));
        ImGui::SameLine(0, 0);
    }
    // What never was live is not from an exposure to a picture.
    const std::string latency =
        state.latency_ms > 0 ? fmt::format("{:.0f} ms   ", state.latency_ms) : "";
    const std::string right =
        state.asks_to_end ? std::string("Esc again to end the programme")
        : !state.question.empty()
            ? state.question
            : fmt::format("{}x{}   {:.1f} pictures/s   {}{}, level {}/{}   F1 help",
                          state.picture ? state.picture->width_px() : 0,
                          state.picture ? state.picture->height_px() : 0, state.picture_rate_hz,
                          latency, state.synthesiser, state.render_level, state.prepare_level);
    ImGui::SetCursorPosX(screen.x - ImGui::CalcTextSize(right.c_str()).x - 0.9f * em());
    text(palette::dim, right);
    ImGui::End();
    ImGui::PopStyleVar(2);
    return height;
}

/// Of a take there are no rates and no latencies, only who is in the set that is shown.
void draw_rigs_of_take(const PanelState& state, const UiFonts& fonts) {
    heading(fonts, "RIGS");
    for (const PanelRig& rig : state.rigs) {
        text(rig.name);
        ImGui::SameLine(0, em());
        if (rig.state == RigState::present)
            text(palette::dim, "in this set");
        else
            text(palette::warn, "missing");
    }
}

void draw_rig_table(const PanelState& state, const UiFonts& fonts) {
    heading(fonts, "RIGS");
    if (!ImGui::BeginTable("rigs", 6, ImGuiTableFlags_SizingFixedFit)) return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("state", 0, 5.2f * em());
    for (const char* number : {"fps", "ms", "lost", "set"})
        ImGui::TableSetupColumn(number, 0, 3.4f * em());
    for (const char* column : {"", "state", "fps", "ms", "lost", "set"}) {
        ImGui::TableNextColumn();
        if (column == std::string("state"))
            text(palette::dim, column);
        else {
            ImGui::PushStyleColor(ImGuiCol_Text, palette::dim);
            text_right(column);
            ImGui::PopStyleColor();
        }
    }
    for (const PanelRig& rig : state.rigs) {
        const StateLook look = look_of(rig.state);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        text(rig.name);
        ImGui::TableNextColumn();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddCircleFilled({at.x + 0.35f * em(), at.y + 0.55f * em()},
                                                    0.27f * em(), ImGui::GetColorU32(look.colour));
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 0.9f * em());
        text(look.colour, look.words);
        cell(fmt::format("{:.1f}", rig.rate_hz));
        cell(fmt::format("{:.0f}", rig.latency_ms));
        ImGui::TableNextColumn();
        if (rig.lost > 0) ImGui::PushStyleColor(ImGuiCol_Text, palette::warn);
        text_right(fmt::format("{}", rig.lost));
        if (rig.lost > 0) ImGui::PopStyleColor();
        ImGui::TableNextColumn();
        if (!rig.set_known) continue;
        const bool is_learning = *rig.set_known < mostly_known;
        if (is_learning) ImGui::PushStyleColor(ImGuiCol_Text, palette::warn);
        text_right(fmt::format("{:.0f} %", 100 * *rig.set_known));
        if (is_learning) ImGui::PopStyleColor();
    }
    ImGui::EndTable();
    for (const PanelRig& rig : state.rigs)
        for (const std::string& worry : rig.worries)
            text(palette::warn, fmt::format("{}: {}", rig.name, worry));
}

void draw_stages(const PanelState& state, const UiFonts& fonts) {
    heading(fonts, "WAY OF A FRAME");
    double most_ms = 1;
    for (const PanelStage& stage : state.stages) most_ms = std::max(most_ms, stage.ms);
    if (!ImGui::BeginTable("stages", 3, ImGuiTableFlags_SizingFixedFit)) return;
    ImGui::TableSetupColumn("name", 0, 4.6f * em());
    ImGui::TableSetupColumn("bar", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("ms", 0, 4.2f * em());
    for (const PanelStage& stage : state.stages) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        text(palette::dim, stage.name);
        ImGui::TableNextColumn();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x;
        const auto share = static_cast<float>(stage.ms / most_ms);
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const float top = at.y + 0.25f * em(), bottom = at.y + 0.85f * em();
        list.AddRectFilled({at.x, top}, {at.x + width, bottom}, IM_COL32(255, 255, 255, 10), 2);
        list.AddRectFilled({at.x, top}, {at.x + std::max(2.0f, share * width), bottom},
                           ImGui::GetColorU32(stage.at_rig ? palette::good : palette::accent), 2);
        ImGui::Dummy({width, em()});
        cell(fmt::format("{:.1f} ms", stage.ms));
    }
    ImGui::EndTable();
    text(palette::good, "at the rigs");
    ImGui::SameLine();
    text(palette::accent, "at the host");
}

void draw_latency(const PanelState& state, const UiFonts& fonts) {
    heading(fonts, "EXPOSURE TO PICTURE");
    if (state.latency_history_ms.empty()) {
        text(palette::dim, "no set yet");
        return;
    }
    const float most =
        *std::max_element(state.latency_history_ms.begin(), state.latency_history_ms.end());
    ImGui::PlotLines("##latency", state.latency_history_ms.data(),
                     static_cast<int>(state.latency_history_ms.size()), 0, nullptr, 0, 1.15f * most,
                     {ImGui::GetContentRegionAvail().x, 3.2f * em()});
    text(fmt::format("{:.0f} ms", state.latency_ms));
    ImGui::SameLine();
    text(palette::dim,
         fmt::format("worst of the last {}: {:.0f} ms", state.latency_history_ms.size(), most));
}

void draw_take(const PanelTake& take, const UiFonts& fonts) {
    ImGui::Spacing();
    heading(fonts, "TAKE");
    ImGui::PushTextWrapPos(0);
    text(palette::dim, take.path);
    if (take.is_running)
        text(palette::dim, fmt::format("{:.1f} s, {:.1f} MB a second", take.duration_s, take.mb_s));
    if (take.left_out > 0) text(palette::warn, fmt::format("{} frames left out", take.left_out));
    if (!take.failure.empty()) text(palette::bad, take.failure);
    ImGui::PopTextWrapPos();
}

void draw_left_panel(const PanelState& state, const UiFonts& fonts, float top) {
    ImGui::SetNextWindowPos({panel_gap * em(), top + panel_gap * em()});
    ImGui::SetNextWindowSize({left_panel_width * em(), 0});
    ImGui::Begin("rigs and times", nullptr, fixed_panel | ImGuiWindowFlags_AlwaysAutoResize);
    const bool is_of_take = state.time && !state.behind_s;
    if (is_of_take)
        draw_rigs_of_take(state, fonts);
    else
        draw_rig_table(state, fonts);
    ImGui::Spacing();
    draw_stages(state, fonts);
    if (!is_of_take) {
        ImGui::Spacing();
        draw_latency(state, fonts);
    }
    if (state.take) draw_take(*state.take, fonts);
    ImGui::End();
}

void draw_novelty(const PanelNovelty& novelty, const UiFonts& fonts) {
    ImGui::Spacing();
    heading(fonts, "PIXELS BY RIG");
    if (!novelty.remark.empty()) {
        ImGui::PushTextWrapPos(0);
        text(palette::warn, novelty.remark);
        ImGui::PopTextWrapPos();
        return;
    }
    if (!ImGui::BeginTable("novelty", 2, ImGuiTableFlags_SizingStretchProp)) return;
    for (const PanelNovelty::Row& row : novelty.rows) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled(
            {at.x, at.y + 0.15f * em()}, {at.x + 0.8f * em(), at.y + 0.95f * em()},
            IM_COL32(row.rgb[0], row.rgb[1], row.rgb[2], 255), 2);
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 1.2f * em());
        text(row.rig);
        cell(fmt::format("{:.1f} %", 100 * row.share));
    }
    ImGui::EndTable();
}

void draw_outputs(const std::vector<PanelOutput>& outputs, const UiFonts& fonts) {
    ImGui::Spacing();
    heading(fonts, "OUTPUTS");
    constexpr int first_key = 5, last_key = 12;
    ImGui::PushTextWrapPos(0);
    int key = first_key;
    for (const PanelOutput& output : outputs) {
        text(key > last_key ? output.name : fmt::format("F{}  {}", key, output.name));
        ++key;
        text(output.is_failed ? palette::bad
             : output.is_on   ? palette::good
                              : palette::dim,
             output.state);
        if (output.is_on) {
            ImGui::SameLine(0, em());
            text(palette::dim,
                 fmt::format("{:.1f} Mbit/s, {} queued", output.mbit_s, output.queued));
        }
        if (output.left_out > 0)
            text(palette::warn, fmt::format("{} pictures left out", output.left_out));
        if (!output.failure.empty()) text(palette::bad, output.failure);
    }
    ImGui::PopTextWrapPos();
}

void draw_camera_panel(const PanelState& state, const UiFonts& fonts, float top) {
    constexpr double deg = 180 / std::numbers::pi;
    const float width = 17.5f * em();
    ImGui::SetNextWindowPos(
        {ImGui::GetIO().DisplaySize.x - width - 0.7f * em(), top + 0.7f * em()});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::Begin("camera", nullptr, fixed_panel | ImGuiWindowFlags_AlwaysAutoResize);
    heading(fonts, "VIRTUAL CAMERA");
    if (ImGui::BeginTable("pose", 2, ImGuiTableFlags_SizingStretchProp)) {
        const auto row = [](const char* name, const std::string& value) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            text(palette::dim, name);
            cell(value);
        };
        const OrbitView& view = state.view;
        row("azimuth", fmt::format("{:.1f}\u00b0", view.azimuth_rad * deg));
        row("elevation", fmt::format("{:.1f}\u00b0", view.elevation_rad * deg));
        row("distance", fmt::format("{:.2f} m", view.distance_m));
        row("field of view", fmt::format("{:.1f}\u00b0", view.field_of_view_rad * deg));
        row("pivot", fmt::format("{:.2f}  {:.2f}  {:.2f}", view.pivot_m.x(), view.pivot_m.y(),
                                 view.pivot_m.z()));
        ImGui::EndTable();
    }
    if (state.coverage) draw_coverage(*state.coverage);
    if (state.move_progress) {
        text(palette::dim, "planned move; steer to take over");
        ImGui::ProgressBar(static_cast<float>(*state.move_progress), {-1, 0.4f * em()}, "");
    }
    if (state.novelty) draw_novelty(*state.novelty, fonts);
    if (!state.outputs.empty()) draw_outputs(state.outputs, fonts);
    if (!state.wheel.empty()) {
        ImGui::PushTextWrapPos(0);
        text(palette::dim, state.wheel);
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

void draw_empty_place(ImVec2 size) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRect(at, {at.x + size.x, at.y + size.y},
                                        ImGui::GetColorU32(palette::line));
    ImGui::Dummy(size);
}

/// In the middle at the bottom, but right of the table of rigs.
void draw_thumbnails(const PanelState& state) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float gap = panel_gap * em(), left = 2 * gap + left_panel_width * em();
    const auto count = static_cast<float>(state.rigs.size());
    const float frame = 2 * ImGui::GetStyle().WindowPadding.x;
    const float width =
        std::min(11.0f * em(), (screen.x - left - frame) / std::max(1.0f, count) - gap);
    const float all = count * (width + gap) - gap + frame;
    ImGui::SetNextWindowPos({std::max(0.5f * screen.x, left + 0.5f * all), screen.y - gap}, 0,
                            {0.5f, 1});
    ImGui::Begin("disparities", nullptr, fixed_panel | ImGuiWindowFlags_AlwaysAutoResize);
    bool first = true;
    for (const PanelRig& rig : state.rigs) {
        if (!first) ImGui::SameLine(0, gap);
        first = false;
        ImGui::BeginGroup();
        const float height = rig.disparity
                                 ? width * static_cast<float>(rig.disparity->height_px()) /
                                       static_cast<float>(rig.disparity->width_px())
                                 : 0.75f * width;
        if (rig.disparity && rig.state == RigState::present)
            ImGui::Image(ui_texture(*rig.disparity), {width, height});
        else
            draw_empty_place({width, height});
        const StateLook look = look_of(rig.state);
        text(rig.name);
        ImGui::SameLine();
        if (rig.state == RigState::present)
            text(palette::dim, "disparity");
        else
            text(look.colour, look.words);
        ImGui::EndGroup();
    }
    ImGui::End();
}

void draw_help(const UiFonts& fonts) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, 0, {0.5f, 0.5f});
    ImGui::Begin("help", nullptr,
                 (fixed_panel & ~ImGuiWindowFlags_NoBringToFrontOnFocus) |
                     ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushFont(fonts.title);
    text("Flying the virtual camera");
    ImGui::PopFont();
    ImGui::Spacing();
    std::vector<std::pair<std::string, const char*>> rows{
        {"left drag, arrow keys", "orbit around the pivot"},
        {"right or middle drag, A D Q E", "shift left, right, down, up"},
        {"wheel, W S", "nearer, farther"},
        {"Ctrl + wheel, + -", "narrower, wider field of view"}};
    for (const ControlCommand& command : control_commands())
        if (std::string words = key_words(command); !words.empty())
            rows.emplace_back(std::move(words), command.does);
    rows.insert(rows.end(), {{"Tab", "show or hide the panels"},
                             {"F1", "show or hide this help"},
                             {"Esc", "end; asks first"}});
    constexpr int columns = 2;
    const std::size_t lines = (rows.size() + columns - 1) / columns;
    if (ImGui::BeginTable("keys", 2 * columns, ImGuiTableFlags_SizingFixedFit)) {
        for (std::size_t i = 0; i < lines * columns; ++i) {
            ImGui::TableNextColumn();
            const std::size_t row = i % columns * lines + i / columns;
            if (row < rows.size()) {
                ImGui::PushFont(fonts.strong);
                text(rows[row].first);
                ImGui::PopFont();
            }
            ImGui::TableNextColumn();
            if (row < rows.size()) text(palette::dim, rows[row].second);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace

void draw_operator_screen(const PanelState& state, const UiFonts& fonts) {
    draw_picture(state);
    if (state.show_panels) {
        float top = draw_top_bar(state, fonts);
        if (state.time) {
            draw_time_line(*state.time, top);
            top += 0.35f * em();
        }
        draw_left_panel(state, fonts, top);
        draw_camera_panel(state, fonts, top);
        if (!state.rigs.empty()) draw_thumbnails(state);
    }
    if (state.show_help) draw_help(fonts);
}

}  // namespace vantage
