#include "common/image/disparity_file.h"

#include <limits>

#include "common/base/error.h"
#include "common/image/colour_map.h"
#include "common/image/image_file.h"
#include "common/image/pfm.h"

namespace vantage {

DisparityForm disparity_form(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension == ".pfm") return DisparityForm::pfm;
    if (extension == ".png") return DisparityForm::png;
    fail(
        "cannot write disparities to {}: the extension must be .pfm (float, pixels) or .png "
        "(16-bit, 1/{} px)",
        path.string(), disparity_steps_per_px);
}

void write_disparity(const std::filesystem::path& path, const DisparityImage& disparity) {
    switch (disparity_form(path)) {
        case DisparityForm::pfm: {
            cv::Mat1f px = to_float_px(disparity);
            px.setTo(std::numeric_limits<float>::infinity(), disparity == 0);
            write_pfm(path, px);
            return;
        }
        case DisparityForm::png:
            write_grey_image(path, disparity);
            return;
    }
}

}  // namespace vantage
