#include "common/image/image_file.h"

#include <array>
#include <cctype>
#include <cstddef>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/image/jpeg.h"
#include "common/image/netpbm.h"
#include "common/image/png.h"

namespace vantage {
namespace {

constexpr std::size_t max_file_bytes = std::size_t{1} << 30;

enum class Format { png, jpeg, netpbm };

/// By the first bytes; nothing: none that is known.
std::optional<Format> format_of(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG")) return Format::png;
    if (text.starts_with("\xff\xd8")) return Format::jpeg;
    if (text.starts_with("P5") || text.starts_with("P6")) return Format::netpbm;
    return std::nullopt;
}

/// One channel of grey or R, G, B, of 8 or 16 bits.
cv::Mat decode(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = read_file(path, max_file_bytes);
    const std::optional<Format> format = format_of(bytes);
    if (!format)
        fail("{} is not a picture that can be read: PNG, JPEG, PGM and PPM can", path.string());
    try {
        switch (*format) {
            case Format::png:
                return decode_png(bytes);
            case Format::jpeg:
                return decode_jpeg(bytes);
            case Format::netpbm:
                return decode_netpbm(bytes);
        }
    } catch (const Error& error) {
        fail("{} is not a picture that can be read: {}", path.string(), error.what());
    }
    return {};
}

/// In which a picture is written, by its name.
Format format_by_name(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == ".png") return Format::png;
    if (extension == ".jpg" || extension == ".jpeg") return Format::jpeg;
    fail("cannot write {}: no picture format goes by the extension '{}'; use .png or .jpg",
         path.string(), path.extension().string());
}

void encode(const std::filesystem::path& path, const cv::Mat& image) {
    const Format format = format_by_name(path);
    std::vector<std::byte> bytes;
    try {
        bytes = format == Format::png ? encode_png(image) : encode_jpeg(image);
    } catch (const Error& error) {
        fail("cannot write {}: {}", path.string(), error.what());
    }
    write_file_atomically(path, bytes);
}

}  // namespace

bool is_picture_file(const std::filesystem::path& path) {
    std::array<std::byte, 4> first{};
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(first.data()), first.size());
    return format_of(std::span(first).first(static_cast<std::size_t>(file.gcount()))).has_value();
}

ColourImage read_colour_image(const std::filesystem::path& path) {
    cv::Mat image = decode(path);
    constexpr double byte_of_word = 255.0 / 65535;
    if (image.depth() == CV_16U) image.convertTo(image, CV_8U, byte_of_word);
    ColourImage rgba;
    cv::cvtColor(image, rgba, image.channels() == 1 ? cv::COLOR_GRAY2RGBA : cv::COLOR_RGB2RGBA);
    return rgba;
}

cv::Mat1w read_code_image(const std::filesystem::path& path) {
    cv::Mat image = decode(path);
    if (image.channels() > 1) {
        std::vector<cv::Mat> channels;
        cv::split(image, channels);
        for (std::size_t i = 1; i < channels.size(); ++i)
            if (cv::norm(channels[0], channels[i], cv::NORM_INF) != 0)
                fail("{} is a colour picture where one channel of codes is expected",
                     path.string());
        image = channels[0];
    }
    cv::Mat1w codes;
    image.convertTo(codes, CV_16U);
    return codes;
}

void require_picture_extension(const std::filesystem::path& path) { (void)format_by_name(path); }

void write_colour_image(const std::filesystem::path& path, const ColourImage& image) {
    cv::Mat rgb;
    cv::cvtColor(image, rgb, cv::COLOR_RGBA2RGB);
    encode(path, rgb);
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
