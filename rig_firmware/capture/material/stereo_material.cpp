#include "rig_firmware/capture/material/stereo_material.h"

#include "common/base/error.h"
#include "common/image/image_file.h"
#include "rig_firmware/capture/material/numbered_files.h"

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

bool is_list(const std::string& name) {
    std::error_code ignored;
    if (std::filesystem::is_directory(name, ignored)) return true;
    return std::filesystem::path(name).filename().string().find_first_of("*?[") !=
               std::string::npos &&
           !std::filesystem::exists(name, ignored);
}

std::unique_ptr<StereoMaterial> open_material(const RigConfig::Source& source) {
    if (source.left.empty())
        fail("the source 'files' needs pictures: name them with 'left' and 'right' in [source]");
    if (is_list(source.left)) return open_pictures(source);
    const bool is_one_file = !NumberedFiles::is_pattern(source.left);
    if (is_one_file && !std::filesystem::exists(source.left))
        fail("there is no file {}", source.left);
    if (!is_one_file || is_picture_file(source.left)) return open_pictures(source);
    if (!source.right.empty() && !std::filesystem::is_regular_file(source.right))
        fail(
            "'left' is the video {} and 'right', {}, is no file: give two videos, or one with both "
            "sides",
            source.left, source.right);
    return open_video(source);
}

}  // namespace vantage
