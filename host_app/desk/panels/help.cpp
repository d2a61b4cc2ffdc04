#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host_app/control/table/control_command.h"
#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

/// A line of the help; a line without keys is a heading.
struct HelpRow {
    std::string keys, does;

    bool is_heading() const { return keys.empty(); }
};

/// The headings, each above the command of this name.
constexpr std::pair<std::string_view, const char*> headings[] = {{"live", "Time"},
                                                                 {"make_clip", "Clips"},
                                                                 {"play_list", "Play list"},
                                                                 {"shot", "Shots and preview"},
                                                                 {"play", "Planned move"},
                                                                 {"horizon", "Camera and wheel"},
                                                                 {"take", "Recording and outputs"}};

std::vector<HelpRow> help_rows() {
    std::vector<HelpRow> rows{{"", "Mouse and keyboard"},
                              {"left drag, arrow keys", "orbit around the pivot"},
                              {"double click", "put the pivot on the surface under the mouse"},
                              {"right drag, A D Q E", "move left, right, down, up"},
                              {"wheel, W S", "move nearer, farther"},
                              {"Ctrl + wheel, + -", "narrow, widen the field of view"},
                              {"drag on the time line", "move through the past"}};
    for (const ControlCommand& command : control_commands()) {
        for (const auto& [name, heading] : headings)
            if (name == command.name) rows.push_back({"", heading});
        if (std::string words = key_words(command); !words.empty())
            rows.push_back({std::move(words), command.does});
    }
    rows.insert(rows.end(),
                {{"", "Desk"},
                 {"Tab", "show the picture alone, or the desk"},
                 {"Shift + Tab", "show or hide the rigs"},
                 {"Ctrl + Shift + Tab", "move the rigs to a window of their own, or back"},
                 {"Ctrl + F1", "show measurements since the start, or camera and outputs"},
                 {"Ctrl + Tab", "show the stage in 3-D, or its plan"},
                 {"Ctrl + arrows, + -", "turn the 3-D view, move nearer, farther"},
                 {"Enter", "type a command with its argument, or a time"},
                 {"F1", "show the pages of this help"},
                 {"Esc", "quit, after a question"}});
    return rows;
}

/// The place of a row. Columns are filled one after the other.
struct Placed {
    std::size_t row, column;
    float y;  ///< from the top of the column
};

/// Distributes the rows to columns. Long descriptions are wrapped to the width of a column.
class HelpColumns {
  public:
    HelpColumns(const Pen& pen, const std::vector<HelpRow>& rows, float words_width, float height)
        : pen_(pen.dry()), words_width_(words_width) {
        std::size_t column = 0;
        float y = 0;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const float gap = rows[i].is_heading() && y > 0 ? 0.4f * pen.em() : 0;
            const float row_height = height_of(rows[i]);
            // A heading is never the last row of a column.
            const float wanted =
                row_height +
                (rows[i].is_heading() && i + 1 < rows.size() ? height_of(rows[i + 1]) : 0);
            if (y > 0 && y + gap + wanted > height) {
                ++column;
                y = 0;
            } else {
                y += gap;
            }
            placed_.push_back({i, column, y});
            y += row_height;
        }
    }
    std::size_t count() const { return placed_.back().column + 1; }
    const std::vector<Placed>& placed() const { return placed_; }

  private:
    float height_of(const HelpRow& row) const {
        if (row.is_heading()) return 1.4f * pen_.em();
        return pen_.text_wrapped(words_width_, 0, 0, palette::dim, row.does);
    }

    Pen pen_;
    float words_width_;
    std::vector<Placed> placed_;
};

}  // namespace

int draw_help(const Pen& pen, float width_px, float height_px, int page) {
    const std::vector<HelpRow> rows = help_rows();
    const float em = pen.em(), pad = em, title_height = 2 * em;
    float keys_width = 0, widest = 0;
    for (const HelpRow& row : rows) {
        keys_width = std::max(keys_width, pen.width_of(row.keys, true) + 0.8f * em);
        widest = std::max(widest, pen.width_of(row.does) + em);
    }
    const float least_words = 17 * em;
    // One to three columns, each no wider than the longest row.
    const auto side_by_side = static_cast<std::size_t>(
        std::clamp((width_px - 2 * pad) / (keys_width + least_words + pad), 1.0f, 3.0f));
    const float column_width =
        std::min((width_px - 2 * pad) / static_cast<float>(side_by_side), keys_width + widest);
    const float words_width = column_width - keys_width - pad;
    const float room = 0.98f * height_px - title_height - 2 * pad;
    const HelpColumns columns(pen, rows, words_width, room);
    const auto pages = static_cast<int>((columns.count() + side_by_side - 1) / side_by_side);
    const auto first = static_cast<std::size_t>(std::clamp(page, 1, pages) - 1) * side_by_side;
    const float width =
        column_width * static_cast<float>(std::min(side_by_side, columns.count())) + pad;
    const float height = room + title_height + 2 * pad;
    const DeskRect box{0.5f * (width_px - width), 0.5f * (height_px - height), width, height};
    const Clipping clipping(pen, box);
    pen.fill(box, palette::panel, 0.3f * em);
    pen.outline(box, palette::line);
    pen.text(box.left + pad, box.top + pad, palette::text, "Keys and mouse", true);
    pen.text_right(box.right() - pad, box.top + pad, palette::dim,
                   page < pages ? fmt::format("page {} of {}   F1: next", page, pages)
                                : std::string("F1: close"));
    for (const Placed& placed : columns.placed()) {
        if (placed.column < first || placed.column >= first + side_by_side) continue;
        const HelpRow& row = rows[placed.row];
        const float left =
            box.left + pad + static_cast<float>(placed.column - first) * column_width;
        const float y = box.top + pad + title_height + placed.y;
        if (row.is_heading()) {
            pen.text(left, y, palette::accent, row.does, true);
            continue;
        }
        pen.text(left, y, palette::text, row.keys, true);
        pen.text_wrapped(words_width, left + keys_width, y, palette::dim, row.does);
    }
    return pages;
}

}  // namespace vantage
