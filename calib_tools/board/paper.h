#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib_tools/board/board_pattern.h"

namespace vantage {

/// A side of a PDF page.
inline constexpr double max_page_m = 5.08;

/// A sheet, metres, the longer side first.
struct Paper {
    std::string name;  ///< "a3", or "600x400 mm"
    double long_m = 0, short_m = 0;
};

/// The sheets that have a name, the smallest first.
const std::vector<Paper>& known_papers();

/// A sheet by its name, or from WIDTHxHEIGHT in millimetres. Throws Error with the names there are.
Paper paper_named(std::string_view text);

/// Width and height, metres, of the page that holds a board with its margin and caption, and, for
/// one of several that are cut out, with its frame.
struct PageSize {
    double width_m = 0, height_m = 0;
    bool fits(const Paper& paper) const;
};
PageSize page_of(const BoardPattern& pattern, bool is_cut_out);

/// The largest side of a square, in whole millimetres, with which the board fits the sheet. Throws
/// Error if that is below 1 mm.
double largest_square_m(BoardPattern pattern, bool is_cut_out, const Paper& paper);

/// Throws Error, with the sizes and the largest square that fits, if the board does not fit.
void require_fit(const BoardPattern& pattern, bool is_cut_out, const Paper& paper);

/// "480 x 374 mm, which fits a2" or "..., more than a2 (594 x 420 mm)": what a print needs. Of the
/// sheet that was asked for, if one was and the page fits it, else of the smallest that fits.
std::string page_in_words(const PageSize& page, const std::optional<Paper>& asked);

}  // namespace vantage
