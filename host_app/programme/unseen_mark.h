#pragma once

#include "common/image/image.h"

namespace vantage {

/// Marks in a rendered picture (alpha as of ViewRenderer::render) what neither was seen nor lies
/// near anything that was: such pixels turn dark and hatched, from a twentieth of the picture's
/// width away from all that was seen on, wholly so from a tenth. Smaller holes keep their filling,
/// which is likely there; a smear over half a picture is no picture of anything.
void mark_unseen(ColourImage& picture);

}  // namespace vantage
