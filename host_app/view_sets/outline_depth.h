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

/// The hull as another camera sees it, with its depth, in the colours of the views that look most
/// alike and see the point. The depth is 0 outside the hull, and where no view sees it. The views
/// have the depth of set_depth_from_outlines().
DepthView hull_view(const std::vector<DepthView>& views, const std::vector<GreyImage>& outlines,
                    const VirtualView& target);

}  // namespace vantage
