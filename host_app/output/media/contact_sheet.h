#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/image/image.h"

namespace vantage {

/// One image of a contact sheet with its caption.
struct SheetStill {
    ColourImage picture;
    std::string caption;
};

/// One row of a contact sheet: the images of one moment.
struct SheetMoment {
    std::string title;
    std::vector<SheetStill> stills;
};

/// Composes a contact sheet: one row per moment, each still in a cell of `cell_width_px` with the
/// aspect ratio of the first still, scaled without distortion. Precondition: at least one moment,
/// and at least one still in each.
ColourImage compose_contact_sheet(const std::string& title, std::span<const SheetMoment> moments,
                                  int cell_width_px);

}  // namespace vantage
