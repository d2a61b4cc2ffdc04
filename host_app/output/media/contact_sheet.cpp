#include "host_app/output/media/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

const cv::Scalar ground(18, 20, 24, 255), cell_ground(0, 0, 0, 255), bright(232, 235, 240, 255),
    dim(150, 158, 170, 255);

constexpr int margin_px = 16, caption_px = 30, moment_title_px = 36, title_px = 60;

/// Draws text on `baseline`, reduced in size if it would be wider than `width_px`.
void write_text(ColourImage& sheet, const std::string& text, cv::Point baseline, int width_px,
                double scale, const cv::Scalar& colour) {
    int descent = 0;
    const cv::Size wanted = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &descent);
    if (wanted.width > width_px) scale *= static_cast<double>(width_px) / wanted.width;
    cv::putText(sheet, text, baseline, cv::FONT_HERSHEY_SIMPLEX, scale, colour, 1, cv::LINE_AA);
}

void place(ColourImage& sheet, const ColourImage& picture, const cv::Rect& cell) {
    cv::rectangle(sheet, cell, cell_ground, cv::FILLED);
    const double scale = std::min(static_cast<double>(cell.width) / picture.cols,
                                  static_cast<double>(cell.height) / picture.rows);
    const cv::Size size(std::max(1, static_cast<int>(std::lround(scale * picture.cols))),
                        std::max(1, static_cast<int>(std::lround(scale * picture.rows))));
    ColourImage fitted;
    cv::resize(picture, fitted, size, 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
    // Alpha holds coverage, which a contact sheet does not show.
    for (cv::Vec4b& pixel : fitted) pixel[3] = 255;
    const cv::Point corner(cell.x + (cell.width - size.width) / 2,
                           cell.y + (cell.height - size.height) / 2);
    fitted.copyTo(sheet(cv::Rect(corner, size)));
}

}  // namespace

ColourImage compose_contact_sheet(const std::string& title, std::span<const SheetMoment> moments,
                                  int cell_width_px) {
    CV_Assert(!moments.empty() && !moments.front().stills.empty());
    const cv::Size shape = moments.front().stills.front().picture.size();
    const int cell_height_px =
        std::max(1, static_cast<int>(std::lround(static_cast<double>(cell_width_px) * shape.height /
                                                 shape.width)));
    std::size_t columns = 0;
    for (const SheetMoment& moment : moments) columns = std::max(columns, moment.stills.size());
    const int row_px = moment_title_px + cell_height_px + caption_px;
    const int width_px = margin_px + static_cast<int>(columns) * (cell_width_px + margin_px);
    ColourImage sheet(title_px + static_cast<int>(moments.size()) * row_px + margin_px, width_px);
    sheet.setTo(ground);

    write_text(sheet, title, {margin_px, 42}, width_px - 2 * margin_px, 0.9, bright);
    int y = title_px;
    for (const SheetMoment& moment : moments) {
        write_text(sheet, moment.title, {margin_px, y + 24}, width_px - 2 * margin_px, 0.55, dim);
        int x = margin_px;
        for (const SheetStill& still : moment.stills) {
            place(sheet, still.picture, {x, y + moment_title_px, cell_width_px, cell_height_px});
            write_text(sheet, still.caption, {x, y + moment_title_px + cell_height_px + 20},
                       cell_width_px, 0.5, bright);
            x += cell_width_px + margin_px;
        }
        y += row_px;
    }
    return sheet;
}

}  // namespace vantage
