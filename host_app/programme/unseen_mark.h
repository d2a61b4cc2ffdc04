#pragma once

#include "common/image/image.h"

namespace vantage {

/// Marks large areas of a rendered frame that no rig saw, with dark hatching. It starts at 1/20 of
/// the frame's width from the nearest pixel that was seen and is opaque from 1/10 on. Smaller holes
/// keep their inpainted content, which is plausible there. Alpha is that of ViewRenderer::render().
void mark_unseen(ColourImage& picture);

}  // namespace vantage
