#include "host_app/session/options/picture_options.h"

#include <charconv>
#include <cstdio>

#include "common/base/error.h"
#include "common/gl/context/limits.h"

namespace vantage {

cv::Size parse_size(const std::string& text) {
    int width = 0, height = 0, used = 0;
    if (std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) != 2 ||
        static_cast<std::size_t>(used) != text.size() || width < 16 || height < 16 ||
        width > PiLimits::max_image_side_px || height > PiLimits::max_image_side_px)
        fail("--size is WIDTHxHEIGHT with 16 to {} pixels each, such as 1280x720, not '{}'",
             PiLimits::max_image_side_px, text);
    return {width, height};
}

double parse_rate(const std::string& text) {
    constexpr double least_hz = 0.1, most_hz = 240;
    double pictures = 0, seconds = 1;
    const char* last = text.data() + text.size();
    std::from_chars_result read = std::from_chars(text.data(), last, pictures);
    if (read.ec == std::errc() && read.ptr != last && *read.ptr == '/')
        read = std::from_chars(read.ptr + 1, last, seconds);
    const double rate_hz = pictures / seconds;
    if (read.ec != std::errc() || read.ptr != last || !(rate_hz >= least_hz && rate_hz <= most_hz))
        fail("--rate is {:g} to {:g} pictures a second, such as 50, 29.97 or 30000/1001, not '{}'",
             least_hz, most_hz, text);
    return rate_hz;
}

}  // namespace vantage
