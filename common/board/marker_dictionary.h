#pragma once

#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// ArUco marker in an image; its corners are clockwise from the marker's own upper left.
struct FoundMarker {
    int id = 0;
    cv::Point2f corners[4];
};

/// ArUco dictionary of OpenCV, by its name without "DICT_", e.g. "4X4_100". It hides the API
/// difference between OpenCV up to 4.6 (contrib) and from 4.7 on (objdetect).
class MarkerDictionary {
  public:
    /// Throws Error that lists the known names.
    explicit MarkerDictionary(std::string_view name);

    int marker_count() const;
    /// Bits of a marker with its black border: 0 black, 1 white; the matrix is square with side
    /// bits + 2.
    cv::Mat1b bits(int id) const;
    std::vector<FoundMarker> find(const GreyImage& picture) const;

  private:
    int number_ = 0;
};

}  // namespace vantage
