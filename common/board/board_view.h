#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// One inner corner of a board as detected in an image.
struct BoardCorner {
    int id = 0;  ///< row * columns + column, plus the number of corners of all earlier boards in
                 ///< the list
    Eigen::Vector3d board_m = Eigen::Vector3d::Zero();  ///< in the board's frame
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();    ///< pixel centres at integers
    int board = 0;                                      ///< index in the board list
};

using BoardCorners = std::vector<BoardCorner>;

/// Result of the search for boards in one image. Without corners, `reason` completes a sentence
/// that begins with the name of the image.
struct BoardSighting {
    BoardCorners corners;
    std::string reason;
    double square_px = 0;        ///< median distance of neighbouring corners
    double blur_px = 0;          ///< median Gaussian sigma of the edges
    double contrast = 0;         ///< median half step from black to white in grey levels
    double burnt_out_share = 0;  ///< share of the board's area with the highest pixel value
    bool mirrored = false;       ///< markers can be read in the mirrored image only
    bool inverted = false;       ///< printed with black and white swapped
    bool layout_is_sure = true;  ///< its markers determine the next field
    bool legacy = false;  ///< has the layout of BoardPattern::legacy, whatever the description says

    bool found() const { return !corners.empty(); }
};

/// Share of the pixels inside the quadrangle (its corners in order, in pixels) that are as bright
/// as a pixel can be: glare on a board. 0 where the quadrangle lies outside the picture.
double burnt_out_share(const GreyImage& picture, const std::array<Eigen::Vector2d, 4>& outline);

}  // namespace vantage
