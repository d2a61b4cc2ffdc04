#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/image/image.h"

namespace vantage {

/// One picture of a contact sheet, with the words below it.
struct SheetStill {
    ColourImage picture;
    std::string caption;
};

/// One row: what was seen at one moment.
struct SheetMoment {
    std::string title;
    std::vector<SheetStill> stills;
};

/// Puts stills on one sheet for people: a row for every moment, every still in a cell of
/// `cell_width_px` with the shape of the first still, scaled to fit without distortion.
/// Precondition: at least one moment, and in each at least one still.
ColourImage compose_contact_sheet(const std::string& title, std::span<const SheetMoment> moments,
                                  int cell_width_px);

}  // namespace vantage
