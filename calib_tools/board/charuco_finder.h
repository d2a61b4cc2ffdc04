#pragma once

#include <string>
#include <vector>

#include "calib_tools/board/board_pattern.h"
#include "calib_tools/board/board_view.h"
#include "calib_tools/board/marker_dictionary.h"
#include "common/image/image.h"

namespace vantage {

/// Column and row of the white square (of the outer grid, from 0) that holds marker `id`: markers
/// are numbered row by row over the squares whose column + row is odd (in the legacy layout, where
/// that differs, even), as OpenCV does.
cv::Point marker_square(const BoardPattern& pattern, int id);
int marker_count(const BoardPattern& pattern);
/// Throws Error if the board's dictionary is unknown or has too few markers for it.
void require_enough_markers(const BoardPattern& pattern);

/// Finds the inner corners of a ChArUco board of which at least four lie near markers that can be
/// read; each is measured by fit_corner. The markers were found in the picture already, of whatever
/// boards. Where the legacy layout of OpenCV is another one, the markers say which it is, if those
/// of two rows can be read; else the description does. `exposure` is the picture as the sensor
/// gave it, where `picture` is inverted.
BoardSighting find_charuco(const GreyImage& picture, const GreyImage& exposure,
                           const BoardPattern& pattern, const std::vector<FoundMarker>& found);

inline constexpr const char* mirrored_reason =
    "is mirrored: the board's markers can be read in a mirror only";
/// True if markers can be read in the mirrored picture.
bool shows_mirrored_markers(const GreyImage& picture, const std::string& dictionary);

}  // namespace vantage
