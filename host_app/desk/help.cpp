#include <algorithm>
#include <utility>

#include "host_app/control/table/control_command.h"
#include "host_app/desk/desk_parts.h"

namespace vantage {
namespace {

std::vector<std::pair<std::string, std::string>> help_rows() {
    std::vector<std::pair<std::string, std::string>> rows{
        {"left drag, arrow keys", "orbit around the pivot"},
        {"double click", "put the pivot on what is there"},
        {"right or middle drag, A D Q E", "shift left, right, down, up"},
        {"wheel, W S", "nearer, farther"},
        {"Ctrl + wheel, + -", "narrower, wider field of view"},
        {"drag along the time line", "go through the past"}};
    for (const ControlCommand& command : control_commands())
        if (std::string words = key_words(command); !words.empty())
            rows.emplace_back(std::move(words), command.does);
    rows.insert(rows.end(), {{"Tab", "the picture alone, or the desk"},
                             {"Shift + Tab", "the rigs' pictures and state, or none"},
                             {"Ctrl + Tab", "the stage from outside, or the plan of it"},
                             {"Ctrl + arrow keys, + -", "around it from outside, nearer, farther"},
                             {"Enter", "type a command with its argument, or a time"},
                             {"F1", "show or hide this help"},
                             {"Esc", "end; asks first"}});
    return rows;
}

}  // namespace

void draw_help(const Pen& pen, float width_px, float height_px) {
    const auto rows = help_rows();
    const float em = pen.em(), pad = em;
    const float keys_width = 16 * em, row_height = 1.3f * em;
    // One column where both fit below one another, else two.
    const float title_height = 2 * em;
    const bool fits =
        static_cast<float>(rows.size()) * row_height + title_height + 2 * pad <= 0.95f * height_px;
    const std::size_t columns = fits ? 1 : 2;
    const std::size_t lines = (rows.size() + columns - 1) / columns;
    const float column_width =
        std::min((width_px - 2 * pad) / static_cast<float>(columns), 40 * em);
    const float width = column_width * static_cast<float>(columns) + pad;
    const float height = static_cast<float>(lines) * row_height + title_height + 2 * pad;
    const DeskRect box{0.5f * (width_px - width), std::max(0.0f, 0.5f * (height_px - height)),
                       width, std::min(height, height_px)};
    const Clipping clipping(pen, box);
    pen.fill(box, palette::panel, 0.3f * em);
    pen.outline(box, palette::line);
    pen.text(box.left + pad, box.top + pad, palette::text, "Keys and mouse", true);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const float left = box.left + pad + static_cast<float>(i / lines) * column_width;
        const float y = box.top + pad + title_height + static_cast<float>(i % lines) * row_height;
        const float keys = std::min(keys_width, 0.45f * column_width);
        pen.text_until(left + keys - 0.5f * em, left, y, palette::text, rows[i].first, true);
        pen.text_until(left + column_width - pad, left + keys, y, palette::dim, rows[i].second);
    }
}

}  // namespace vantage
