#include "calib_tools/board/board_drawing.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <hpdf.h>

#include "common/base/error.h"
#include "common/board/charuco_finder.h"
#include "common/board/marker_dictionary.h"

namespace vantage {
namespace {

constexpr double points_per_m = 72 / 0.0254;
constexpr double caption_m = 0.014;
/// Heights above the lower edge of the page; printers leave some millimetres blank.
constexpr double caption_text_m = 0.006, ruler_line_m = 0.011, ruler_mark_m = 0.0015;
constexpr double ruler_m = 0.1;
constexpr double around_frame_m = 0.01;

[[noreturn]] void pdf_failed(HPDF_STATUS error, HPDF_STATUS detail, void*) {
    fail("the PDF could not be made (library error {:#x}, {})", error, detail);
}

struct FreePdf {
    void operator()(void* pdf) const { HPDF_Free(static_cast<HPDF_Doc>(pdf)); }
};

float points(double m) { return static_cast<float>(m * points_per_m); }

/// Adds a page with a board. `face` begins the caption of a board that is cut out and glued to a
/// body. On a given sheet the board is centred.
void add_page(HPDF_Doc pdf, const BoardPattern& pattern, const std::string& face,
              const std::optional<Paper>& paper) {
    const bool is_cut_out = !face.empty();
    const PageSize needed = page_of(pattern, is_cut_out);
    PageSize sheet = needed;
    if (paper) {
        require_fit(pattern, is_cut_out, *paper);
        const bool is_wide = needed.width_m > needed.height_m;
        sheet = is_wide ? PageSize{paper->long_m, paper->short_m}
                        : PageSize{paper->short_m, paper->long_m};
    }
    if (std::max(sheet.width_m, sheet.height_m) > max_page_m)
        fail("a board of {:.2f} x {:.2f} m is larger than a PDF page may be ({:g} m a side)",
             sheet.width_m, sheet.height_m, max_page_m);
    const double frame_m = is_cut_out ? around_frame_m : 0, margin = board_margin_m(pattern);
    const double board_width_m = needed.width_m - 2 * frame_m;
    const double board_height_m = needed.height_m - 2 * frame_m - caption_m;
    // PDF coordinates start at the lower left.
    const double left = 0.5 * (sheet.width_m - needed.width_m) + frame_m;
    const double top = sheet.height_m - 0.5 * (sheet.height_m - needed.height_m) - frame_m;
    const HPDF_Page page = HPDF_AddPage(pdf);
    HPDF_Page_SetWidth(page, points(sheet.width_m));
    HPDF_Page_SetHeight(page, points(sheet.height_m));
    for (const BoardPatch& patch : board_patches(pattern)) {
        HPDF_Page_SetGrayFill(page, patch.black ? 0.0f : 1.0f);
        HPDF_Page_Rectangle(page, points(left + margin + patch.place_m.x),
                            points(top - margin - patch.place_m.br().y),
                            points(patch.place_m.width), points(patch.place_m.height));
        HPDF_Page_Fill(page);
    }
    HPDF_Page_SetGrayFill(page, 0);
    HPDF_Page_SetLineWidth(page, 0.5f);
    if (is_cut_out) {
        HPDF_Page_Rectangle(page, points(left), points(top - board_height_m), points(board_width_m),
                            points(board_height_m));
        HPDF_Page_Stroke(page);
    }
    const double text_left = left - frame_m + std::min(margin, 0.01);
    const double bottom = 0.5 * (sheet.height_m - needed.height_m);
    if (needed.width_m > ruler_m + 2 * std::min(margin, 0.01)) {
        const double line = bottom + ruler_line_m;
        HPDF_Page_MoveTo(page, points(text_left), points(line));
        HPDF_Page_LineTo(page, points(text_left + ruler_m), points(line));
        for (const double end : {text_left, text_left + ruler_m}) {
            HPDF_Page_MoveTo(page, points(end), points(line - ruler_mark_m));
            HPDF_Page_LineTo(page, points(end), points(line + ruler_mark_m));
        }
        HPDF_Page_Stroke(page);
    }
    const std::string caption = fmt::format(
        "{}{}x{} inner corners, square {:g} mm{}. Print at 100 %: the line above is 100 mm.", face,
        pattern.columns, pattern.rows, 1000 * pattern.square_m,
        pattern.kind == BoardKind::charuco
            ? fmt::format(", marker {:g} mm, {} from {}", 1000 * pattern.marker_m,
                          pattern.dictionary, pattern.first_marker)
            : "");
    HPDF_Page_BeginText(page);
    HPDF_Page_SetFontAndSize(page, HPDF_GetFont(pdf, "Helvetica", nullptr), 7);
    HPDF_Page_TextOut(page, points(text_left), points(bottom + caption_text_m), caption.c_str());
    HPDF_Page_EndText(page);
}

}  // namespace

double board_margin_m(const BoardPattern& pattern) { return pattern.square_m; }

PageSize page_of(const BoardPattern& pattern, bool is_cut_out) {
    const double around_m = 2 * (board_margin_m(pattern) + (is_cut_out ? around_frame_m : 0));
    return {(pattern.columns + 1) * pattern.square_m + around_m,
            (pattern.rows + 1) * pattern.square_m + around_m + caption_m};
}

std::vector<BoardPatch> board_patches(const BoardPattern& pattern) {
    std::vector<BoardPatch> patches;
    const double s = pattern.square_m;
    for (int r = 0; r <= pattern.rows; ++r)
        for (int c = 0; c <= pattern.columns; ++c)
            if ((r + c) % 2 == (pattern.starts_white() ? 1 : 0))
                patches.push_back({{c * s, r * s, s, s}, true});
    if (pattern.kind != BoardKind::charuco) return patches;
    const MarkerDictionary dictionary(pattern.dictionary);
    const double margin = 0.5 * (s - pattern.marker_m);
    for (int id = 0; id < marker_count(pattern); ++id) {
        const cv::Point square = marker_square(pattern, id);
        const cv::Mat1b bits = dictionary.bits(pattern.first_marker + id);
        const double x0 = square.x * s + margin, y0 = square.y * s + margin;
        const double bit = pattern.marker_m / bits.cols;
        patches.push_back({{x0, y0, pattern.marker_m, pattern.marker_m}, true});
        for (int y = 0; y < bits.rows; ++y)
            for (int x = 0; x < bits.cols; ++x)
                if (bits(y, x)) patches.push_back({{x0 + x * bit, y0 + y * bit, bit, bit}, false});
    }
    return patches;
}

GreyImage draw_board(const BoardPattern& pattern, int square_px) {
    const double scale = square_px / pattern.square_m, margin = board_margin_m(pattern);
    const auto pixel = [&](double m) { return static_cast<int>(std::lround(m * scale)); };
    GreyImage picture(pixel((pattern.rows + 1) * pattern.square_m + 2 * margin),
                      pixel((pattern.columns + 1) * pattern.square_m + 2 * margin), uchar{255});
    for (const BoardPatch& patch : board_patches(pattern)) {
        const cv::Point from(pixel(patch.place_m.x + margin), pixel(patch.place_m.y + margin));
        const cv::Point to(pixel(patch.place_m.br().x + margin),
                           pixel(patch.place_m.br().y + margin));
        picture(cv::Rect(from, to)).setTo(patch.black ? 0 : 255);
    }
    return picture;
}

std::vector<std::byte> board_as_pdf(const std::vector<BoardPattern>& faces,
                                    const std::optional<Paper>& paper) {
    const std::unique_ptr<void, FreePdf> owner(HPDF_New(pdf_failed, nullptr));
    const auto pdf = static_cast<HPDF_Doc>(owner.get());
    if (!pdf) fail("the PDF could not be made: no memory");
    for (std::size_t i = 0; i < faces.size(); ++i)
        add_page(pdf, faces[i],
                 faces.size() > 1
                     ? fmt::format("Face {} of {}: cut along the frame. ", i + 1, faces.size())
                     : "",
                 paper);
    HPDF_SaveToStream(pdf);
    HPDF_UINT32 size = HPDF_GetStreamSize(pdf);
    std::vector<std::byte> bytes(size);
    HPDF_ReadFromStream(pdf, reinterpret_cast<HPDF_BYTE*>(bytes.data()), &size);
    bytes.resize(size);
    return bytes;
}

}  // namespace vantage
