#include "common/image/image_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/atomic_file.h"
#include "common/base/error.h"

namespace vantage {
namespace {

constexpr std::size_t max_file_bytes = std::size_t{1} << 30;

/// A JPEG without the end-of-image marker after its last scan was cut short; the decoder would fill
/// the rest with grey and say nothing.
bool is_jpeg_cut_short(std::span<const std::byte> bytes) {
    const auto last = [&](unsigned char marker) {
        const std::array pattern = {std::byte{0xff}, std::byte{marker}};
        return std::find_end(bytes.begin(), bytes.end(), pattern.begin(), pattern.end());
    };
    constexpr unsigned char start_of_image = 0xd8, start_of_scan = 0xda, end_of_image = 0xd9;
    const bool is_jpeg =
        bytes.size() >= 2 && bytes[0] == std::byte{0xff} && bytes[1] == std::byte{start_of_image};
    return is_jpeg &&
           (last(end_of_image) == bytes.end() || last(end_of_image) < last(start_of_scan));
}

cv::Mat decode(const std::filesystem::path& path, int flags) {
    const std::vector<std::byte> bytes = read_file(path, max_file_bytes);
    cv::Mat image;
    if (is_jpeg_cut_short(bytes))
        fail("{} is damaged: it is cut off, the end of the JPEG data is missing", path.string());
    if (!bytes.empty()) {
        try {
            image = cv::imdecode(cv::Mat(1, static_cast<int>(bytes.size()), CV_8U,
                                         const_cast<std::byte*>(bytes.data())),
                                 flags);
        } catch (const cv::Exception&) {
            image.release();
        }
    }
    if (image.empty())
        fail("{} is not a picture that can be read (damaged, or an unknown format)", path.string());
    if (image.cols > max_image_side_px || image.rows > max_image_side_px)
        fail("{} is {}x{}; pictures up to {} pixels a side are taken", path.string(), image.cols,
             image.rows, max_image_side_px);
    return image;
}

void encode(const std::filesystem::path& path, const cv::Mat& image) {
    require_picture_extension(path);
    std::vector<unsigned char> bytes;
    bool encoded = false;
    try {
        encoded = cv::imencode(path.extension().string(), image, bytes);
    } catch (const cv::Exception&) {
        encoded = false;
    }
    if (!encoded) fail("cannot write {}: its format does not take this picture", path.string());
    write_file_atomically(path, std::as_bytes(std::span(bytes)));
}

}  // namespace

ColourImage read_colour_image(const std::filesystem::path& path) {
    ColourImage rgba;
    cv::cvtColor(decode(path, cv::IMREAD_COLOR), rgba, cv::COLOR_BGR2RGBA);
    return rgba;
}

cv::Mat1w read_code_image(const std::filesystem::path& path) {
    cv::Mat image = decode(path, cv::IMREAD_UNCHANGED);
    if (image.depth() != CV_8U && image.depth() != CV_16U)
        fail("{} is neither an 8-bit nor a 16-bit picture", path.string());
    if (image.channels() > 1) {
        std::vector<cv::Mat> channels;
        cv::split(image, channels);
        for (std::size_t i = 1; i < channels.size() && i < 3; ++i)
            if (cv::norm(channels[0], channels[i], cv::NORM_INF) != 0)
                fail("{} is a colour picture where one channel of codes is expected",
                     path.string());
        image = channels[0];
    }
    cv::Mat1w codes;
    image.convertTo(codes, CV_16U);
    return codes;
}

void require_picture_extension(const std::filesystem::path& path) {
    if (path.has_extension() && cv::haveImageWriter(path.string())) return;
    fail("cannot write {}: no picture format goes by the extension '{}'; use .png or .jpg",
         path.string(), path.extension().string());
}

void write_colour_image(const std::filesystem::path& path, const ColourImage& image) {
    cv::Mat bgr;
    cv::cvtColor(image, bgr, cv::COLOR_RGBA2BGR);
    encode(path, bgr);
}

void write_grey_image(const std::filesystem::path& path, const cv::Mat& one_channel_8_or_16_bit) {
    CV_Assert(one_channel_8_or_16_bit.channels() == 1);
    encode(path, one_channel_8_or_16_bit);
}

GreyImage to_grey(const ColourImage& image) {
    GreyImage grey(image.size());
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x) {
            const cv::Vec4b& c = image(y, x);
            // 77 + 150 + 29 = 256: integer arithmetic that CPU and GPU do alike.
            grey(y, x) =
                static_cast<unsigned char>((77 * c[0] + 150 * c[1] + 29 * c[2] + 128) >> 8);
        }
    return grey;
}

}  // namespace vantage
