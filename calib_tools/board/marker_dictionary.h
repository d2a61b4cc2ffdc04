#pragma once

#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// An ArUco marker found in a picture: corners clockwise from the marker's own upper left.
struct FoundMarker {
    int id = 0;
    cv::Point2f corners[4];
};

/// One of OpenCV's ArUco dictionaries by its name without "DICT_", such as "4X4_100". Hides the
/// difference between OpenCV up to 4.6 (contrib) and from 4.7 on (objdetect).
class MarkerDictionary {
  public:
    /// Throws Error with the names that there are.
    explicit MarkerDictionary(std::string_view name);

    int marker_count() const;
    /// Bits of a marker with its black border: 0 black, 1 white; (bits + 2) squared.
    cv::Mat1b bits(int id) const;
    std::vector<FoundMarker> find(const GreyImage& picture) const;

  private:
    int number_ = 0;
};

}  // namespace vantage
