#include "calib_tools/board/paper.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "calib_tools/board/board_drawing.h"
#include "common/base/error.h"

namespace vantage {
namespace {

constexpr double mm = 1e-3, least_square_m = 1 * mm;
/// Smallest difference of two lengths on paper.
constexpr double tolerance_m = 0.01 * mm;

std::string sheet_in_words(const Paper& paper) {
    return fmt::format("{:g} x {:g} mm", paper.long_m / mm, paper.short_m / mm);
}

std::optional<Paper> paper_of_size(std::string_view text) {
    const std::size_t cross = text.find('x');
    if (cross == std::string_view::npos) return std::nullopt;
    const auto side_m = [](std::string_view digits) -> double {
        double value = 0;
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), value);
        const bool is_number = error == std::errc() && end == digits.data() + digits.size();
        return is_number && value >= 1 && value <= max_page_m / mm ? value * mm : 0;
    };
    const double width_m = side_m(text.substr(0, cross)), height_m = side_m(text.substr(cross + 1));
    if (width_m == 0 || height_m == 0) return std::nullopt;
    Paper paper{"", std::max(width_m, height_m), std::min(width_m, height_m)};
    paper.name = sheet_in_words(paper);
    return paper;
}

}  // namespace

const std::vector<Paper>& known_papers() {
    static const std::vector<Paper> papers{{"letter", 279.4 * mm, 215.9 * mm},
                                           {"a4", 297 * mm, 210 * mm},
                                           {"a3", 420 * mm, 297 * mm},
                                           {"a2", 594 * mm, 420 * mm}};
    return papers;
}

Paper paper_named(std::string_view text) {
    std::string lower(text), names;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const Paper& paper : known_papers()) {
        if (paper.name == lower) return paper;
        names += paper.name + ", ";
    }
    if (std::optional<Paper> paper = paper_of_size(lower)) return *paper;
    fail("'{}' is no paper: there are {}and WIDTHxHEIGHT in mm, such as 600x400 (1 to {:g} a side)",
         text, names, max_page_m / mm);
}

bool PageSize::fits(const Paper& paper) const {
    return std::max(width_m, height_m) <= paper.long_m + tolerance_m &&
           std::min(width_m, height_m) <= paper.short_m + tolerance_m;
}

double largest_square_m(BoardPattern pattern, bool is_cut_out, const Paper& paper) {
    const auto fits = [&](int whole_mm) {
        pattern.square_m = whole_mm * mm;
        return page_of(pattern, is_cut_out).fits(paper);
    };
    int whole_mm = 0;
    while (fits(whole_mm + 1)) ++whole_mm;
    if (whole_mm * mm < least_square_m)
        fail("{} ({}) is too small for a {} board: its squares would be below {:g} mm", paper.name,
             sheet_in_words(paper), pattern.size_name(), least_square_m / mm);
    return whole_mm / 1000.0;
}

void require_fit(const BoardPattern& pattern, bool is_cut_out, const Paper& paper) {
    const PageSize page = page_of(pattern, is_cut_out);
    if (page.fits(paper)) return;
    fail(
        "a {} board of {:g} mm squares needs {:g} x {:g} mm with its margin and caption, and {} "
        "is {}: take squares of {:g} mm or less, a larger paper, or fewer corners",
        pattern.size_name(), pattern.square_m / mm, page.width_m / mm, page.height_m / mm,
        paper.name, sheet_in_words(paper), largest_square_m(pattern, is_cut_out, paper) / mm);
}

std::string page_in_words(const PageSize& page, const std::optional<Paper>& asked) {
    const std::string size = fmt::format("{:g} x {:g} mm", page.width_m / mm, page.height_m / mm);
    if (asked && page.fits(*asked)) return fmt::format("{}, which fits {}", size, asked->name);
    for (const Paper& paper : known_papers())
        if (page.fits(paper)) return fmt::format("{}, which fits {}", size, paper.name);
    const Paper& largest = known_papers().back();
    return fmt::format("{}, more than {} ({})", size, largest.name, sheet_in_words(largest));
}

}  // namespace vantage
