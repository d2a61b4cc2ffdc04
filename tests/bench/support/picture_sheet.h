#pragma once

#include <string>
#include <vector>

#include "common/image/image.h"

namespace vantage {

/// Pictures beside and below each other, each with its name above, for people to compare.
class PictureSheet {
  public:
    /// Pictures of another size are scaled to a cell's.
    PictureSheet(cv::Size cell, int columns) : cell_(cell), columns_(columns) {}

    void add(const std::string& name, const ColourImage& picture);
    /// Of as many rows as it takes; black where there are no more pictures.
    ColourImage picture() const;

  private:
    cv::Size cell_;
    int columns_;
    std::vector<cv::Mat> cells_;
};

}  // namespace vantage
