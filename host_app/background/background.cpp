#include "host_app/background/background.h"

#include "common/config/yaml/number_checksum.h"

namespace vantage {

std::string calibration_of(const DepthView& camera, cv::Size colour_size, cv::Size depth_size) {
    NumberChecksum sum;
    sum.add_rows(camera.K);
    sum.add(camera.world_from_camera);
    sum.add(camera.baseline_m);
    sum.add(camera.doffs_px);
    for (const int side :
         {colour_size.width, colour_size.height, depth_size.width, depth_size.height})
        sum.add(side);
    return checksum_text(sum.hex());
}

}  // namespace vantage
