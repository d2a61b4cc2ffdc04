#include "host_app/output/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "common/image/colour_map.h"
#include "common/image/image.h"
#include "common/image/image_file.h"
#include "common/wire/frame_message.h"

namespace vantage {
namespace {

/// Colours a rig's disparity for display: blue is far, red is the nearest searched disparity, black
/// is unknown. The range is the same for all frames.
ColourImage disparity_picture(const RigFrame& frame) {
    constexpr float usual_search_px = 64;
    const float most_px = frame.max_disparity_px > 0 ? frame.max_disparity_px : usual_search_px;
    return colour_map_disparity(to_float_px(frame.disparity), 0, most_px);
}

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

constexpr std::size_t sheet_moments = 5;
constexpr int sheet_cell_px = 480;

SheetRow row_of(const FlightMoment& moment, std::size_t row) {
    SheetRow stills{moment.title, {{moment.picture, "virtual view"}}};
    std::vector<const RigFrame*> frames;
    for (const FrameSet::Slot& slot : moment.set->slots)
        if (slot.frame && slot.frame->has_pictures()) frames.push_back(slot.frame.get());
    if (frames.empty()) return stills;
    // Each row shows another rig.
    const RigFrame& frame = *frames[row % frames.size()];
    stills.stills.push_back({frame.colour, fmt::format("{}: colour", frame.rig)});
    stills.stills.push_back(
        {disparity_picture(frame), fmt::format("{}: disparity, 0 (blue) to {:.0f} px (red)",
                                               frame.rig, frame.max_disparity_px)});
    return stills;
}

}  // namespace

ColourImage compose_contact_sheet(const std::string& title, std::span<const SheetRow> moments,
                                  int cell_width_px) {
    CV_Assert(!moments.empty() && !moments.front().stills.empty());
    const cv::Size shape = moments.front().stills.front().picture.size();
    const int cell_height_px =
        std::max(1, static_cast<int>(std::lround(static_cast<double>(cell_width_px) * shape.height /
                                                 shape.width)));
    std::size_t columns = 0;
    for (const SheetRow& moment : moments) columns = std::max(columns, moment.stills.size());
    const int row_px = moment_title_px + cell_height_px + caption_px;
    const int width_px = margin_px + static_cast<int>(columns) * (cell_width_px + margin_px);
    ColourImage sheet(title_px + static_cast<int>(moments.size()) * row_px + margin_px, width_px);
    sheet.setTo(ground);

    write_text(sheet, title, {margin_px, 42}, width_px - 2 * margin_px, 0.9, bright);
    int y = title_px;
    for (const SheetRow& moment : moments) {
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

void MomentCollector::add(FlightMoment moment) {
    kept_.push_back(std::move(moment));
    if (kept_.size() < 2 * wanted_ + 1) return;
    // With twice the stride, the next wanted frame follows the last even index.
    std::vector<FlightMoment> even;
    for (std::size_t i = 0; i < kept_.size(); i += 2) even.push_back(std::move(kept_[i]));
    kept_ = std::move(even);
    stride_ *= 2;
}

std::vector<FlightMoment> MomentCollector::chosen() const {
    if (kept_.size() <= wanted_) return kept_;
    std::vector<FlightMoment> moments;
    for (std::size_t i = 0; i < wanted_; ++i) {
        // Rounded to the nearest evenly spaced index.
        const std::size_t place = (2 * i * (kept_.size() - 1) + wanted_ - 1) / (2 * (wanted_ - 1));
        moments.push_back(kept_[place]);
    }
    return moments;
}

ContactSheetSink::ContactSheetSink(std::filesystem::path path)
    : path_(std::move(path)), moments_(sheet_moments) {}

void ContactSheetSink::take(const ProgrammePicture& picture) {
    if (moments_.wants(picture.tick)) moments_.add({picture.title, picture.overlaid, picture.set});
}

void ContactSheetSink::finish() {
    std::vector<SheetRow> rows;
    for (const FlightMoment& moment : moments_.chosen())
        rows.push_back(row_of(moment, rows.size()));
    if (rows.empty()) return;
    write_colour_image(
        path_, compose_contact_sheet("Vantage: flight of the virtual camera", rows, sheet_cell_px));
}

}  // namespace vantage
