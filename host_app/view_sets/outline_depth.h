#pragma once

#include <vector>

#include "common/image/image.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Computes the depth of each view's foreground from the outlines of all views: the nearest point
/// of the visual hull (Matusik et al., 2000) along each pixel's line of sight that two other views
/// see, or the only other one. `outlines[i]` is
/// above 127 where the foreground is in views[i], in the size of its picture, or empty for a view
/// without an outline, which gets no depth. Pixels outside the outline have no depth either. Throws
/// Error unless at least two views have an outline.
void set_depth_from_outlines(std::vector<DepthView>& views, const std::vector<GreyImage>& outlines);

}  // namespace vantage
