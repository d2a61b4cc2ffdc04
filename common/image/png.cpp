#include "common/image/png.h"

#include <cstdlib>
#include <memory>

#include <opencv2/imgproc.hpp>
#include <spng.h>

#include "common/base/error.h"
#include "common/image/exif_orientation.h"
#include "common/image/picture_size.h"

namespace vantage {
namespace {

/// Files a fifth larger than at the best level for a fraction of the time.
constexpr int compression_level = 3;
/// More than this DEFLATE never saves.
constexpr std::size_t most_deflated = 1032;

struct ContextDeleter {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, ContextDeleter>;

Context new_context(int flags) {
    Context context(spng_ctx_new(flags));
    if (!context) fail("there is no memory for a PNG");
    return context;
}

void require(int result) {
    if (result != 0) fail("it is a damaged or cut off PNG ({})", spng_strerror(result));
}

cv::Mat without_alpha(const cv::Mat& image) {
    cv::Mat plain;
    if (image.channels() == 2)
        cv::extractChannel(image, plain, 0);
    else if (image.channels() == 4)
        cv::cvtColor(image, plain, cv::COLOR_RGBA2RGB);
    else
        plain = image;
    return plain;
}

}  // namespace

DecodedPng decode_png(std::span<const std::byte> bytes) {
    const Context context = new_context(0);
    require(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()));
    spng_ihdr head{};
    require(spng_get_ihdr(context.get(), &head));
    require_picture_size(head.width, head.height);
    std::size_t packed_size = 0;
    require(spng_decoded_image_size(context.get(), SPNG_FMT_RAW, &packed_size));
    if (packed_size / most_deflated > bytes.size())
        fail("it is a damaged or cut off PNG ({} bytes are too few for {}x{})", bytes.size(),
             head.width, head.height);
    const bool is_grey = head.color_type == SPNG_COLOR_TYPE_GRAYSCALE ||
                         head.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA;
    const bool has_alpha = head.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA ||
                           head.color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
    constexpr int two_bytes = 16;
    const bool is_wide = head.bit_depth == two_bytes;
    // What is asked for as it is in the file comes with its alpha.
    const bool is_as_it_is = is_wide || (is_grey && has_alpha);
    const int format = is_as_it_is ? SPNG_FMT_PNG : is_grey ? SPNG_FMT_G8 : SPNG_FMT_RGB8;
    const int channels = (is_grey ? 1 : 3) + (is_as_it_is && has_alpha ? 1 : 0);
    cv::Mat image(static_cast<int>(head.height), static_cast<int>(head.width),
                  CV_MAKETYPE(is_wide ? CV_16U : CV_8U, channels));
    require(
        spng_decode_image(context.get(), image.data, image.total() * image.elemSize(), format, 0));
    DecodedPng decoded{without_alpha(image), 1};
    if (spng_exif exif{}; spng_get_exif(context.get(), &exif) == 0)
        decoded.orientation = exif_orientation(std::as_bytes(std::span(exif.data, exif.length)));
    return decoded;
}

std::vector<std::byte> encode_png(const cv::Mat& image) {
    const bool is_grey = image.type() == CV_8UC1 || image.type() == CV_16UC1;
    const bool has_alpha = image.type() == CV_8UC4;
    if (!is_grey && !has_alpha && image.type() != CV_8UC3) fail("a PNG does not take this picture");
    const cv::Mat whole = image.isContinuous() ? image : image.clone();
    const Context context = new_context(SPNG_CTX_ENCODER);
    spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
    spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, compression_level);
    constexpr int bits_of_byte = 8;
    spng_ihdr head{
        .width = static_cast<std::uint32_t>(whole.cols),
        .height = static_cast<std::uint32_t>(whole.rows),
        .bit_depth = static_cast<std::uint8_t>(bits_of_byte * whole.elemSize1()),
        .color_type = static_cast<std::uint8_t>(is_grey     ? SPNG_COLOR_TYPE_GRAYSCALE
                                                : has_alpha ? SPNG_COLOR_TYPE_TRUECOLOR_ALPHA
                                                            : SPNG_COLOR_TYPE_TRUECOLOR),
        .compression_method = 0,
        .filter_method = 0,
        .interlace_method = SPNG_INTERLACE_NONE};
    spng_set_ihdr(context.get(), &head);
    if (const int result =
            spng_encode_image(context.get(), whole.data, whole.total() * whole.elemSize(),
                              SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE))
        fail("a PNG cannot be made of this picture ({})", spng_strerror(result));
    std::size_t size = 0;
    int result = 0;
    const std::unique_ptr<void, decltype(&std::free)> buffer(
        spng_get_png_buffer(context.get(), &size, &result), std::free);
    if (!buffer) fail("a PNG cannot be made of this picture ({})", spng_strerror(result));
    const auto* first = static_cast<const std::byte*>(buffer.get());
    return {first, first + size};
}

}  // namespace vantage
