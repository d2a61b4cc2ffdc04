#pragma once

#include <string>
#include <vector>

#include "common/board/board_pattern.h"
#include "common/board/board_view.h"
#include "common/board/marker_dictionary.h"
#include "common/image/image.h"

namespace vantage {

/// Column and row of the white square (in the outer grid, from 0) that holds marker `id`. As in
/// OpenCV, markers are numbered row by row over the squares with odd column + row, or even column +
/// row where the legacy layout differs.
cv::Point marker_square(const BoardPattern& pattern, int id);
int marker_count(const BoardPattern& pattern);
/// Throws Error if the dictionary is unknown or has too few markers for the board.
void require_enough_markers(const BoardPattern& pattern);

/// Finds the inner corners of a ChArUco board with at least four corners near readable markers, and
/// measures each with fit_corner(). `markers` are the detected markers of all boards. If OpenCV's
/// legacy layout differs, markers of two rows decide between the layouts, else the description
/// does. `exposure` is the image of the sensor, also if `picture` is inverted.
BoardSighting find_charuco(const GreyImage& picture, const GreyImage& exposure,
                           const BoardPattern& pattern, const std::vector<FoundMarker>& found);

inline constexpr const char* mirrored_reason =
    "is mirrored: the board's markers can be read in a mirror only";
/// True if markers can be read in the mirrored image.
bool shows_mirrored_markers(const GreyImage& picture, const std::string& dictionary);

}  // namespace vantage
