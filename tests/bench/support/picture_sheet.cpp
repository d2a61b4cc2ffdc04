#include "tests/bench/support/picture_sheet.h"

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

constexpr int label_height_px = 18;

void write_label(cv::Mat& picture, const std::string& text) {
    cv::rectangle(picture, {0, 0, picture.cols, label_height_px}, cv::Scalar(0, 0, 0, 255),
                  cv::FILLED);
    cv::putText(picture, text, {5, 13}, cv::FONT_HERSHEY_SIMPLEX, 0.45,
                cv::Scalar(255, 255, 255, 255), 1, cv::LINE_AA);
}

}  // namespace

void PictureSheet::add(const std::string& name, const ColourImage& picture) {
    cv::Mat cell;
    cv::resize(picture, cell, cell_, 0, 0, cv::INTER_AREA);
    write_label(cell, name);
    cells_.push_back(cell);
}

ColourImage PictureSheet::picture() const {
    const int rows = (static_cast<int>(cells_.size()) + columns_ - 1) / columns_;
    ColourImage sheet(rows * cell_.height, columns_ * cell_.width, cv::Vec4b(0, 0, 0, 255));
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const int column = static_cast<int>(i) % columns_, row = static_cast<int>(i) / columns_;
        cells_[i].copyTo(
            sheet(cv::Rect(cv::Point(column * cell_.width, row * cell_.height), cell_)));
    }
    return sheet;
}

}  // namespace vantage
