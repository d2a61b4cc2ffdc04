#pragma once

#include <algorithm>

#include <opencv2/core.hpp>

namespace vantage {

/// The codes that a picture of 16 bits uses. Cameras of 10 or 12 bits leave the upper bits of the
/// container empty; scaled by the container's range their pictures would be nearly black.
struct CodeRange {
    int white = 0;  ///< 255, 1023, 4095, 16383 or 65535; 0: no picture of 16 bits was seen

    /// The range of pictures that belong together, such as the two sides of a rig.
    CodeRange joined(const CodeRange& other) const { return {std::max(white, other.white)}; }
    /// Bits of a code, for messages.
    int bits() const;
    bool operator==(const CodeRange&) const = default;
};

/// The smallest range of 8, 10, 12, 14 or 16 bits that holds the largest code of the picture. Of a
/// picture of 8 bits: no range.
CodeRange range_of_codes(const cv::Mat& picture);

/// The picture in 8 bits a channel, its code `white` as 255.
cv::Mat to_bytes(const cv::Mat& picture, int white);

}  // namespace vantage
