#include "common/image/image_file.h"

#include <algorithm>
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
#include "common/base/log.h"
#include "common/image/exif_orientation.h"
#include "common/image/jpeg.h"
#include "common/image/netpbm.h"
#include "common/image/png.h"

namespace vantage {
namespace {

constexpr std::size_t max_file_bytes = std::size_t{1} << 30;

enum class Format { png, jpeg, netpbm };

/// By the first bytes; nothing: none that is read.
std::optional<Format> format_of(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG")) return Format::png;
    if (text.starts_with("\xff\xd8")) return Format::jpeg;
    if (text.size() > 1 && text[0] == 'P' && text[1] >= '1' && text[1] <= '6')
        return Format::netpbm;
    return std::nullopt;
}

/// The name of an image format that Vantage recognises but does not read; empty if unknown.
std::string_view foreign_format(std::string_view text) {
    using namespace std::string_view_literals;
    if (text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv)) return "a TIFF";
    if (text.starts_with("BM")) return "a BMP";
    if (text.starts_with("GIF8")) return "a GIF";
    if (text.starts_with("RIFF") && text.size() > 12 && text.substr(8).starts_with("WEBP"))
        return "a WebP";
    if (text.starts_with("P7")) return "a PAM";
    if (text.starts_with("Pf") || text.starts_with("PF")) return "a PFM, which holds floats";
    if (text.starts_with("v/1\x01"sv)) return "an OpenEXR picture";
    if (text.size() > 12 && text.substr(4).starts_with("ftyp")) return "a HEIF picture or a video";
    return {};
}

/// A picture as its file has it.
struct DecodedFile {
    cv::Mat image;         ///< one channel of grey or R, G, B, of 8 or 16 bits
    int stated_white = 0;  ///< code of white by the file's header; 0: it only states its container
    int orientation = 1;
    std::string oddity;  ///< as DecodedJpeg's
};

DecodedFile decode_netpbm_file(std::span<const std::byte> bytes) {
    NetpbmPicture picture = decode_netpbm(bytes);
    constexpr int container = 0xffff;
    return {picture.image, picture.largest_code == container ? 0 : picture.largest_code, 1, {}};
}

DecodedFile decode_bytes(std::span<const std::byte> bytes, Format format) {
    switch (format) {
        case Format::png: {
            DecodedPng png = decode_png(bytes);
            return {png.image, 0, png.orientation, {}};
        }
        case Format::jpeg: {
            DecodedJpeg jpeg = decode_jpeg(bytes);
            return {jpeg.image, 0, jpeg.orientation, std::move(jpeg.oddity)};
        }
        case Format::netpbm:
            break;
    }
    return decode_netpbm_file(bytes);
}

DecodedFile decode(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = read_file(path, max_file_bytes);
    const std::optional<Format> format = format_of(bytes);
    if (!format) {
        const std::string_view name =
            foreign_format({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        if (name.empty())
            fail("{} is not a picture that can be read: PNG, JPEG, PBM, PGM and PPM can",
                 path.string());
        fail("{} is {}; pictures are read as PNG, JPEG, PBM, PGM and PPM: convert it to PNG",
             path.string(), name);
    }
    try {
        return decode_bytes(bytes, *format);
    } catch (const Error& error) {
        fail("{} is not a picture that can be read: {}", path.string(), error.what());
    }
}

/// Warns of what a viewer would show otherwise, and of departures from the standard.
void warn_of_oddities(const DecodedFile& decoded, const std::filesystem::path& path) {
    if (!decoded.oddity.empty())
        log_warning_once("picture oddity " + decoded.oddity,
                         fmt::format("{} departs from the JPEG standard without losing a pixel "
                                     "({}); it is taken, and so are others like it",
                                     path.string(), decoded.oddity));
    if (decoded.orientation != 1)
        log_warning_once(
            fmt::format("picture orientation {}", decoded.orientation),
            fmt::format("{} states in its EXIF data that viewers show it {}; Vantage takes the "
                        "pixels as they are stored, here and in other pictures like it. Turn the "
                        "file itself if it should stand upright (exiftran -ai FILE)",
                        path.string(), orientation_in_words(decoded.orientation)));
}

CodeRange range_of(const DecodedFile& decoded) {
    return decoded.stated_white > 0 ? CodeRange{} : range_of_codes(decoded.image);
}

ColourImage to_colour_image(const DecodedFile& decoded, const CodeRange& range) {
    constexpr int white_byte = 255;
    const int white = decoded.stated_white > 0          ? decoded.stated_white
                      : decoded.image.depth() == CV_16U ? range.white
                                                        : white_byte;
    const cv::Mat image = to_bytes(decoded.image, white);
    ColourImage rgba;
    cv::cvtColor(image, rgba, image.channels() == 1 ? cv::COLOR_GRAY2RGBA : cv::COLOR_RGB2RGBA);
    return rgba;
}

/// True unless the header alone shows that the file has 8 bits a sample.
bool may_be_deep(const std::filesystem::path& path) {
    std::array<std::byte, 32> first{};
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(first.data()), first.size());
    const std::optional<Format> format =
        format_of(std::span(first).first(static_cast<std::size_t>(file.gcount())));
    constexpr std::size_t png_bit_depth_at = 24;
    if (format == Format::png) return first[png_bit_depth_at] == std::byte{16};
    return format == Format::netpbm;
}

void tell_range(const CodeRange& range, const std::string& first) {
    constexpr int container = 0xffff;
    if (range.white > 0 && range.white < container)
        log_warning_once(
            fmt::format("picture range {}", range.white),
            fmt::format("{}: no code of the 16-bit pictures is above {}, so they are taken as "
                        "pictures of {} bits, white at {}",
                        first, range.white, range.bits(), range.white));
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
    const DecodedFile decoded = decode(path);
    warn_of_oddities(decoded, path);
    const CodeRange range = range_of(decoded);
    tell_range(range, path.string());
    return to_colour_image(decoded, range);
}

ColourImage read_colour_image(const std::filesystem::path& path, CodeRange& range) {
    const DecodedFile decoded = decode(path);
    warn_of_oddities(decoded, path);
    const CodeRange own = range_of(decoded);
    if (own.white > range.white) {
        if (range.white > 0)
            log_warning(
                "{} has codes above {}: it and the pictures after it are taken as pictures "
                "of {} bits instead of {}",
                path.string(), range.white, own.bits(), range.bits());
        range = own;
    }
    return to_colour_image(decoded, range);
}

std::pair<ColourImage, ColourImage> read_colour_pair(const std::filesystem::path& left,
                                                     const std::filesystem::path& right) {
    const DecodedFile decoded_left = decode(left), decoded_right = decode(right);
    warn_of_oddities(decoded_left, left);
    warn_of_oddities(decoded_right, right);
    const CodeRange range = range_of(decoded_left).joined(range_of(decoded_right));
    tell_range(range, left.string());
    return {to_colour_image(decoded_left, range), to_colour_image(decoded_right, range)};
}

CodeRange common_code_range(std::span<const std::filesystem::path> files,
                            std::size_t most_samples) {
    std::vector<std::filesystem::path> deep;
    const std::size_t samples = std::min(files.size(), most_samples);
    for (std::size_t i = 0; i < samples; ++i)
        if (const auto& file = files[i * files.size() / samples]; may_be_deep(file))
            deep.push_back(file);
    std::vector<CodeRange> ranges(deep.size());
    cv::parallel_for_(cv::Range(0, static_cast<int>(deep.size())), [&](const cv::Range& part) {
        for (int i = part.start; i < part.end; ++i) try {
                const auto at = static_cast<std::size_t>(i);
                ranges[at] = range_of(decode(deep[at]));
            } catch (const Error&) {
                // Its reader says what is wrong with it.
            }
    });
    CodeRange range;
    for (const CodeRange& own : ranges) range = range.joined(own);
    if (!deep.empty()) tell_range(range, deep.front().string());
    return range;
}

cv::Mat1w read_code_image(const std::filesystem::path& path) {
    cv::Mat image = decode(path).image;
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

void write_with_alpha(const std::filesystem::path& path, const ColourImage& image,
                      const cv::Mat1b& alpha) {
    CV_Assert(alpha.size() == image.size());
    if (format_by_name(path) != Format::png) return write_colour_image(path, image);
    ColourImage with_alpha = image.clone();
    cv::insertChannel(alpha, with_alpha, 3);
    encode(path, with_alpha);
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
