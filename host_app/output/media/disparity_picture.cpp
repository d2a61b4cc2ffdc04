#include "host_app/output/media/disparity_picture.h"

#include "common/image/colour_map.h"

namespace vantage {

ColourImage disparity_picture(const RigFrame& frame) {
    constexpr float usual_search_px = 64;
    const float most_px = frame.max_disparity_px > 0 ? frame.max_disparity_px : usual_search_px;
    return colour_map_disparity(to_float_px(frame.disparity), 0, most_px);
}

}  // namespace vantage
