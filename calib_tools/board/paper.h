#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/board/board_pattern.h"

namespace vantage {

/// Longest side of a PDF page in metres.
inline constexpr double max_page_m = 5.08;

/// Sheet of paper in metres, the longer side first.
struct Paper {
    std::string name;  ///< "a3", or "600x400 mm"
    double long_m = 0, short_m = 0;
};

/// All named sheets, smallest first.
const std::vector<Paper>& known_papers();

/// Parses the name of a sheet, or WIDTHxHEIGHT in millimetres. Throws Error that lists the names.
Paper paper_named(std::string_view text);

/// Width and height in metres of a page with a board, its margin and caption, and, for a board that
/// is cut out, its frame.
struct PageSize {
    double width_m = 0, height_m = 0;
    bool fits(const Paper& paper) const;
};
PageSize page_of(const BoardPattern& pattern, bool is_cut_out);

/// Largest side of a square, in whole millimetres expressed in metres, with which the board fits
/// the sheet. Throws Error if it is below 1 mm.
double largest_square_m(BoardPattern pattern, bool is_cut_out, const Paper& paper);

/// Throws Error with the sizes and the largest possible square if the board does not fit.
void require_fit(const BoardPattern& pattern, bool is_cut_out, const Paper& paper);

/// Text about the paper that a print needs: "480 x 374 mm, which fits a2" or "..., more than a2
/// (594 x 420 mm)". It names the requested sheet if the page fits it, else the smallest sheet that
/// fits.
std::string page_in_words(const PageSize& page, const std::optional<Paper>& asked);

}  // namespace vantage
