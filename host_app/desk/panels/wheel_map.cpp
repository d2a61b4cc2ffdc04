#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

using Kind = DeskWheel::Kind;

constexpr float pi = std::numbers::pi_v<float>;
/// Detents of one turn of the drawn disc.
constexpr float detents_a_turn = 24;
/// Angle of the drawn ring either way, about that of a ShuttleXpress.
constexpr float ring_end_rad = 0.6f * pi;

// Lengths in ems.
constexpr float box_width = 66, box_height = 35, pad = 1, title_height = 2.4f, foot_height = 4.2f;
/// Size of the message that no wheel is connected.
constexpr float empty_width = 44, empty_height = 7;
constexpr float figure_width = 23, list_width = 19;

const ImVec4& colour_of(const DeskWheel& wheel, std::size_t control) {
    if (wheel.controls[control].is_held) return palette::good;
    return control == wheel.selected ? palette::accent : palette::line;
}

/// Returns the selected control if it is of this kind, or the first control of the kind.
std::optional<std::size_t> shown_of(const DeskWheel& wheel, Kind kind) {
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < wheel.controls.size(); ++i)
        if (wheel.controls[i].kind == kind && (!first || i == wheel.selected)) first = i;
    return first;
}

std::vector<std::size_t> buttons_of(const DeskWheel& wheel) {
    std::vector<std::size_t> buttons;
    for (std::size_t i = 0; i < wheel.controls.size(); ++i)
        if (wheel.controls[i].kind == Kind::button) buttons.push_back(i);
    return buttons;
}

/// Draws a wheel: its buttons in an arc above it, or in a grid if there are many, its
/// spring-centred ring, and the disc in the ring.
class Figure {
  public:
    Figure(const Pen& pen, const DeskRect& rect, const DeskWheel& wheel, DeskSpots& spots)
        : pen_(pen), rect_(rect), wheel_(wheel), spots_(spots) {
        const auto buttons = static_cast<float>(buttons_of(wheel).size());
        const float em = pen.em();
        is_arc_ = buttons <= 6;
        rows_ = is_arc_ ? 0 : std::ceil(buttons / columns);
        const float grid = rows_ * row_height * em;
        radius_ = std::min(0.26f * rect.width, 0.36f * (rect.height - grid));
        centre_ = {rect.left + 0.5f * rect.width,
                   rect.top + (is_arc_ ? 0.62f : 0.5f) * (rect.height - grid)};
    }

    void draw() const {
        if (const auto ring = shown_of(wheel_, Kind::axis)) draw_ring(*ring);
        if (const auto disc = shown_of(wheel_, Kind::turns)) draw_disc(*disc);
        const std::vector<std::size_t> buttons = buttons_of(wheel_);
        for (std::size_t i = 0; i < buttons.size(); ++i)
            draw_button(buttons[i], is_arc_ ? place_in_arc(i, buttons.size()) : place_in_grid(i));
    }

  private:
    static constexpr float columns = 4, row_height = 3.1f;

    ImVec2 around(float radius, float angle_rad) const {
        return {centre_.x + radius * std::sin(angle_rad), centre_.y - radius * std::cos(angle_rad)};
    }
    void spot(const DeskRect& rect, std::size_t control) const {
        spots_.wheel_controls.push_back({rect, static_cast<int>(control) + 1});
    }
    void draw_ring(std::size_t control) const {
        const float em = pen_.em(), thickness = 0.9f * em;
        const auto at = static_cast<float>(wheel_.controls[control].at);
        const auto arc = [&](float from, float to, const ImVec4& colour, float width) {
            // ImGui's angles start at the right and run clockwise.
            pen_.list().PathArcTo(centre_, radius_, from - 0.5f * pi, to - 0.5f * pi, 48);
            pen_.list().PathStroke(packed(colour), 0, width);
        };
        arc(-ring_end_rad, ring_end_rad, palette::trough, thickness);
        if (at != 0)
            arc(std::min(0.0f, at * ring_end_rad), std::max(0.0f, at * ring_end_rad), palette::good,
                thickness);
        const float angle = at * ring_end_rad;
        pen_.list().AddLine(around(radius_ - thickness, angle), around(radius_ + thickness, angle),
                            packed(colour_of(wheel_, control)), 0.35f * em);
        label_of(control, {centre_.x - radius_, centre_.y + 1.05f * radius_, 2 * radius_, 0});
        spot({centre_.x - radius_ - em, centre_.y - radius_ - em, 2 * (radius_ + em), em * 2},
             control);
    }
    void draw_disc(std::size_t control) const {
        const float radius = 0.66f * radius_, em = pen_.em();
        const auto turns =
            static_cast<float>(std::fmod(wheel_.controls[control].at, double{detents_a_turn}) /
                               double{detents_a_turn});
        pen_.list().AddCircleFilled(centre_, radius, packed(palette::trough), 48);
        pen_.list().AddCircle(centre_, radius, packed(colour_of(wheel_, control)), 48, 0.2f * em);
        pen_.list().AddCircleFilled(around(0.72f * radius, 2 * pi * turns), 0.16f * radius,
                                    packed(palette::dim), 24);
        label_of(control, {centre_.x - radius, centre_.y - 1.3f * em, 2 * radius, 0});
        spot({centre_.x - 0.7f * radius, centre_.y - 0.7f * radius, 1.4f * radius, 1.4f * radius},
             control);
    }
    void centred(const DeskRect& rect, float y, const ImVec4& colour, const std::string& words,
                 bool is_strong) const {
        const float width = std::min(pen_.width_of(words, is_strong), rect.width);
        pen_.text_until(rect.right(), rect.left + 0.5f * (rect.width - width), y, colour, words,
                        is_strong);
    }
    /// Draws a control's name and below it its command.
    void label_of(std::size_t control, const DeskRect& rect) const {
        const bool is_in_hand = control == wheel_.selected;
        centred(rect, rect.top, is_in_hand ? palette::text : palette::dim,
                wheel_.controls[control].name, true);
        centred(rect, rect.top + 1.25f * pen_.em(), palette::dim, wheel_.controls[control].does,
                false);
    }
    DeskRect place_in_arc(std::size_t i, std::size_t count) const {
        const float em = pen_.em(), width = 4.9f * em, height = 2.8f * em;
        const float spread = 0.42f * pi;
        const float share =
            count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) * 2 - 1 : 0;
        const ImVec2 at = around(radius_ + 3.2f * em, share * spread);
        return {at.x - 0.5f * width, at.y - 0.5f * height, width, height};
    }
    DeskRect place_in_grid(std::size_t i) const {
        const float em = pen_.em(), width = rect_.width / columns;
        const auto column = static_cast<float>(i % static_cast<std::size_t>(columns));
        const auto row = static_cast<float>(i / static_cast<std::size_t>(columns));
        return {rect_.left + column * width, rect_.bottom() - (rows_ - row) * row_height * em,
                width - 0.3f * em, (row_height - 0.3f) * em};
    }
    void draw_button(std::size_t control, const DeskRect& rect) const {
        const bool is_filled = wheel_.controls[control].is_held || control == wheel_.selected;
        const float em = pen_.em();
        pen_.fill(rect, is_filled ? colour_of(wheel_, control) : palette::trough, 0.3f * em);
        pen_.outline(rect, colour_of(wheel_, control));
        const DeskRect words = rect.shrunk(0.2f * em);
        centred(words, words.top, is_filled ? palette::on_badge : palette::text,
                wheel_.controls[control].name, true);
        centred(words, words.top + 1.2f * em, is_filled ? palette::on_badge : palette::dim,
                wheel_.controls[control].does, false);
        spot(rect, control);
    }

    const Pen& pen_;
    DeskRect rect_;
    const DeskWheel& wheel_;
    DeskSpots& spots_;
    ImVec2 centre_;
    float radius_ = 0, rows_ = 0;
    bool is_arc_ = true;
};

/// Returns the first visible row, so that the selected one is near the middle.
std::size_t first_of(std::size_t count, std::size_t in_hand, std::size_t room) {
    if (count <= room) return 0;
    return std::min(in_hand > room / 2 ? in_hand - room / 2 : 0, count - room);
}

/// Calls `draw_row(i, row)` for each row that fits.
template <class Draw>
void draw_rows(const Pen& pen, const DeskRect& rect, std::size_t count, std::size_t in_hand,
               const Draw& draw_row) {
    const float height = 1.5f * pen.em();
    const auto room = static_cast<std::size_t>(std::max(rect.height / height, 1.0f));
    const std::size_t first = first_of(count, in_hand, room);
    for (std::size_t i = first; i < std::min(count, first + room); ++i) {
        const DeskRect row{rect.left, rect.top + static_cast<float>(i - first) * height, rect.width,
                           height};
        if (i == in_hand) pen.fill(row, palette::trough, 0.2f * pen.em());
        draw_row(i, row);
    }
}

void draw_list(const Pen& pen, const DeskRect& rect, const DeskWheel& wheel, DeskSpots& spots) {
    const float em = pen.em(), name_width = 6.5f * em;
    draw_rows(
        pen, rect, wheel.controls.size(), wheel.selected, [&](std::size_t i, const DeskRect& row) {
            const DeskWheel::Control& control = wheel.controls[i];
            const bool is_in_hand = i == wheel.selected;
            const float y = row.top + 0.2f * em;
            if (control.is_held)
                pen.list().AddCircleFilled({row.left + 0.5f * em, y + 0.55f * em}, 0.3f * em,
                                           packed(palette::good));
            pen.text_until(row.left + name_width, row.left + 1.2f * em, y,
                           is_in_hand ? palette::text : palette::dim, control.name, true);
            pen.text_until(row.right() - 0.3f * em, row.left + name_width + 0.4f * em, y,
                           control.does == "nothing" ? palette::dim : palette::text, control.does);
            spots.wheel_controls.push_back({row, static_cast<int>(i) + 1});
        });
}

void draw_choices(const Pen& pen, const DeskRect& rect, const DeskWheel& wheel) {
    const float em = pen.em(), name_width = 9.5f * em;
    pen.text_until(rect.right(), rect.left, rect.top, palette::accent,
                   fmt::format("{}: > {}_", wheel.controls[wheel.selected].name, wheel.typed),
                   true);
    const DeskRect rows{rect.left, rect.top + 2 * em, rect.width, rect.height - 2 * em};
    if (wheel.choices.empty())
        pen.text_until(rect.right(), rect.left, rows.top, palette::warn, "no command matches");
    draw_rows(pen, rows, wheel.choices.size(), wheel.chosen,
              [&](std::size_t i, const DeskRect& row) {
                  const float y = row.top + 0.2f * em;
                  pen.text_until(row.left + name_width, row.left + 0.3f * em, y,
                                 i == wheel.chosen ? palette::text : palette::dim,
                                 wheel.choices[i].action, true);
                  pen.text_until(row.right() - 0.2f * em, row.left + name_width + 0.3f * em, y,
                                 palette::dim, wheel.choices[i].does);
              });
}

void draw_graph(const Pen& pen, const DeskRect& rect, const DeskWheel::Feel& feel) {
    const auto width = static_cast<float>(feel.to - feel.from);
    const auto most = static_cast<float>(std::max(feel.most, 1e-6));
    const auto x_of = [&](double at) {
        return rect.left + rect.width * static_cast<float>(at - feel.from) / width;
    };
    const auto y_of = [&](double asks) {
        const float share = std::clamp(static_cast<float>(asks) / most, -1.0f, 1.0f);
        return rect.top + 0.5f * rect.height * (1 - share);
    };
    pen.fill(rect, palette::ground);
    if (feel.dead_zone > 0)
        pen.fill({x_of(-feel.dead_zone), rect.top, x_of(feel.dead_zone) - x_of(-feel.dead_zone),
                  rect.height},
                 palette::trough);
    pen.list().AddLine({rect.left, y_of(0)}, {rect.right(), y_of(0)}, packed(palette::tick));
    pen.list().AddLine({x_of(0), rect.top}, {x_of(0), rect.bottom()}, packed(palette::tick));
    std::vector<ImVec2> points;
    for (std::size_t i = 0; i < feel.response.size(); ++i)
        points.emplace_back(rect.left + rect.width * static_cast<float>(i) /
                                            static_cast<float>(feel.response.size() - 1),
                            y_of(feel.response[i]));
    pen.list().AddPolyline(points.data(), static_cast<int>(points.size()), packed(palette::accent),
                           0, 0.16f * pen.em());
    pen.outline(rect, palette::line);
    pen.list().AddCircleFilled({x_of(feel.at), y_of(feel.asks)}, 0.45f * pen.em(),
                               packed(palette::warn));
}

void draw_feel(const Pen& pen, const DeskRect& rect, const DeskWheel& wheel) {
    const float em = pen.em(), row_height = 1.5f * em;
    const DeskWheel::Feel& feel = *wheel.feel;
    const bool has_rest = wheel.controls[wheel.selected].kind == Kind::axis;
    const std::string none = "none (no spring centre)";
    const std::pair<const char*, std::string> rows[] = {
        {has_rest ? "factor" : "steps per detent", fmt::format("{:.2f}", feel.steps)},
        {"dead zone", has_rest ? fmt::format("{:.0f} %", 100 * feel.dead_zone) : none},
        {"curve", has_rest ? fmt::format("{:.1f}", feel.curve) : none},
        {"inverted", feel.inverted ? "yes" : "no"}};
    float y = rect.top;
    for (std::size_t i = 0; i < std::size(rows); ++i, y += row_height) {
        const bool is_in_hand = i == wheel.feel_in_hand;
        if (is_in_hand)
            pen.fill({rect.left, y, rect.width, row_height}, palette::trough, 0.2f * em);
        const float line = y + 0.2f * em;
        pen.text(rect.left + 0.3f * em, line, is_in_hand ? palette::text : palette::dim,
                 rows[i].first, is_in_hand);
        pen.text_until(rect.right() - 0.3f * em, rect.left + 9 * em, line, palette::text,
                       is_in_hand ? fmt::format("<  {}  >", rows[i].second) : rows[i].second);
    }
    const float asks_height = 1.6f * em;
    const DeskRect graph{rect.left, y + 0.6f * em, rect.width,
                         std::max(rect.bottom() - y - 0.6f * em - asks_height, em)};
    draw_graph(pen, graph, feel);
    pen.text_until(rect.right(), rect.left, graph.bottom() + 0.3f * em, palette::dim,
                   fmt::format("output {:+.2f} {}", feel.asks, feel.unit));
}

void draw_foot(const Pen& pen, const DeskRect& rect, const DeskWheel& wheel) {
    const char* hint =
        wheel.is_choosing
            ? "Type to filter the list. Up, Down: choose. Enter: assign the command. Esc: keep the "
              "old one."
            : "Move a control, click it, or press Up or Down to select it. Letters or Enter: "
              "choose its command. Tab, Left, Right: adjust its response. Ctrl + S: save. Esc: "
              "close.";
    float y = rect.top;
    y += pen.text_wrapped(rect.width, rect.left, y, palette::dim, hint);
    if (!wheel.remark.empty())
        pen.text_wrapped(rect.width, rect.left, y, palette::warn, wheel.remark);
    else if (wheel.is_changed)
        pen.text_until(rect.right(), rect.left, y, palette::dim, "will be saved in " + wheel.file);
}

}  // namespace

void draw_wheel_map(const Pen& pen, float width_px, float height_px, const DeskWheel& wheel,
                    DeskSpots& spots) {
    const float em = pen.em();
    const bool is_empty = wheel.controls.empty();
    const float width = std::min((is_empty ? empty_width : box_width) * em, width_px),
                height = std::min((is_empty ? empty_height : box_height) * em, height_px);
    const DeskRect box{0.5f * (width_px - width), 0.5f * (height_px - height), width, height};
    const Clipping clipping(pen, box);
    pen.fill(box, palette::panel, 0.3f * em);
    pen.outline(box, palette::line);
    const DeskRect inner = box.shrunk(pad * em);
    float x = pen.text(inner.left, inner.top, palette::text,
                       wheel.name.empty() ? "Jog map" : wheel.name, true) +
              em;
    if (wheel.is_changed)
        x = pen.badge(x, inner.top - 0.2f * em, 1.5f * em, "NOT SAVED", palette::warn);
    const float top = inner.top + title_height * em;
    if (is_empty) {
        pen.text_wrapped(inner.width, inner.left, top, palette::text,
                         "No jog wheel is connected. Connect one, or simulate one with: sudo "
                         "vantage jog simulate. Esc: close.");
        return;
    }
    pen.text_until(inner.right(), x, inner.top, palette::dim,
                   "the wheel is inactive while this map is open");
    const DeskRect foot{inner.left, inner.bottom() - foot_height * em, inner.width,
                        foot_height * em};
    const DeskRect figure{inner.left, top, figure_width * em, foot.top - top - em};
    const DeskRect list{figure.right() + em, top, list_width * em, figure.height};
    const DeskRect side{list.right() + em, top, inner.right() - list.right() - em, figure.height};
    Figure(pen, figure, wheel, spots).draw();
    draw_list(pen, list, wheel, spots);
    if (wheel.is_choosing)
        draw_choices(pen, side, wheel);
    else if (wheel.feel)
        draw_feel(pen, side, wheel);
    else
        pen.text_wrapped(side.width, side.left, side.top, palette::dim,
                         fmt::format("{} is a button. Enter: choose its command.",
                                     wheel.controls[wheel.selected].name));
    draw_foot(pen, foot, wheel);
}

}  // namespace vantage
