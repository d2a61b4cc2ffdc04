#include "common/board/board_pattern.h"

#include <charconv>
#include <cmath>

#include "common/base/error.h"

namespace vantage {

std::string BoardPattern::size_name() const { return fmt::format("{}x{}", columns, rows); }

void BoardPattern::validate() const {
    if (columns < 3 || rows < 3 || columns > 100 || rows > 100)
        fail("a board of {}x{} inner corners cannot be used: 3 to 100 a side are needed", columns,
             rows);
    if (!(square_m >= 1e-4 && square_m <= 10))
        fail("a square of {} m is not possible: 0.0001 to 10 metres are taken", square_m);
    if (kind == BoardKind::charuco && !(marker_m > 0 && marker_m < square_m))
        fail("a marker of {} m does not fit into a square of {} m", marker_m, square_m);
    if (first_marker < 0) fail("marker {} cannot be: markers count from 0", first_marker);
}

BoardPattern chessboard_pattern(std::string_view size, double square_m) {
    BoardPattern pattern;
    const std::size_t cross = size.find('x');
    const auto number = [&](std::string_view digits, int& value) {
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return error == std::errc() && end == digits.data() + digits.size();
    };
    if (cross == std::string_view::npos || !number(size.substr(0, cross), pattern.columns) ||
        !number(size.substr(cross + 1), pattern.rows))
        fail("board size '{}' is not COLUMNSxROWS of inner corners, such as 9x6", size);
    pattern.square_m = square_m;
    pattern.validate();
    return pattern;
}

}  // namespace vantage
