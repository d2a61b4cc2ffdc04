#include "tests/hil/usb_camera/yuyv_picture.h"

#include <opencv2/imgproc.hpp>

#include "common/image/image_file.h"

namespace vantage {

cv::Mat2b yuyv_picture(const std::filesystem::path& file, const cv::Size& size) {
    cv::Mat small;
    cv::resize(to_grey(read_colour_image(file)), small, size, 0, 0, cv::INTER_AREA);
    constexpr double luma_range = 219.0 / 255.0, luma_black = 16;
    constexpr uchar no_colour = 128;
    small.convertTo(small, CV_8U, luma_range, luma_black);
    cv::Mat2b picture(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            picture(y, x) = cv::Vec2b(small.at<uchar>(y, x), no_colour);
    return picture;
}

}  // namespace vantage
