#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// One inner corner of a board, seen in a picture.
struct BoardCorner {
    int id = 0;  ///< row * columns + column; after those of the boards before it in a set
    Eigen::Vector3d board_m = Eigen::Vector3d::Zero();  ///< in the board's frame
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();    ///< pixel centres at integers
    int board = 0;                                      ///< of the set that is looked for
};

using BoardCorners = std::vector<BoardCorner>;

/// What was found of a board in one picture. Without corners, `reason` is the rest of a sentence
/// that begins with the picture's name.
struct BoardSighting {
    BoardCorners corners;
    std::string reason;
    double square_px = 0;        ///< median distance of neighbouring corners
    double blur_px = 0;          ///< median Gaussian sigma of the edges
    double contrast = 0;         ///< median half step from black to white, grey levels
    double burnt_out_share = 0;  ///< of the board's area: as bright as can be
    bool mirrored = false;       ///< markers can be read in the mirrored picture only
    bool inverted = false;       ///< printed with black and white swapped
    bool layout_is_sure = true;  ///< its markers tell the next
    bool legacy = false;         ///< laid out as BoardPattern::legacy says, described so or not

    bool found() const { return !corners.empty(); }
};

/// Share of the pixels inside the quadrangle (its corners in order, in pixels) that are as bright
/// as a pixel can be: glare on a board. 0 where the quadrangle lies outside the picture.
double burnt_out_share(const GreyImage& picture, const std::array<Eigen::Vector2d, 4>& outline);

}  // namespace vantage
