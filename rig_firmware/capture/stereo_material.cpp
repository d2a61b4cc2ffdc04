#include "rig_firmware/capture/stereo_material.h"

#include <opencv2/imgcodecs.hpp>

#include "common/base/error.h"

namespace vantage {

StereoPair split_side_by_side(const ColourImage& picture, const std::string& what) {
    if (picture.cols < 2 || picture.cols % 2 != 0)
        fail(
            "{} is {} px wide, and two pictures side by side need an even width; or name the other "
            "side with 'right'",
            what, picture.cols);
    const int half = picture.cols / 2;
    return {picture.colRange(0, half), picture.colRange(half, picture.cols)};
}

std::unique_ptr<StereoMaterial> open_material(const RigConfig::Source& source) {
    if (source.left.empty())
        fail("the source 'files' needs pictures: name them with 'left' and 'right' in [source]");
    const std::filesystem::path left = source.left;
    const bool is_one_file =
        source.right.empty() && left.filename().string().find('%') == std::string::npos;
    if (is_one_file && !std::filesystem::exists(left)) fail("there is no file {}", source.left);
    if (is_one_file && std::filesystem::is_regular_file(left) && !cv::haveImageReader(source.left))
        return open_video(source);
    return open_pictures(source);
}

}  // namespace vantage
