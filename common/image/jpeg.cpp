#include "common/image/jpeg.h"

#include <memory>

#include <turbojpeg.h>

#include "common/base/error.h"
#include "common/image/picture_size.h"

namespace vantage {
namespace {

constexpr int quality = 95;

struct HandleDeleter {
    void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, HandleDeleter>;

}  // namespace

cv::Mat decode_jpeg(std::span<const std::byte> bytes) {
    const Handle handle(tjInitDecompress());
    if (!handle) fail("there is no memory for a JPEG");
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    int width = 0, height = 0, sampling = 0, colours = 0;
    if (tjDecompressHeader3(handle.get(), data, bytes.size(), &width, &height, &sampling,
                            &colours) != 0)
        fail("it is a damaged JPEG ({})", tjGetErrorStr2(handle.get()));
    require_picture_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    if (colours == TJCS_CMYK || colours == TJCS_YCCK) fail("it is a JPEG for printing, in CMYK");
    const bool is_grey = colours == TJCS_GRAY;
    cv::Mat image(height, width, is_grey ? CV_8UC1 : CV_8UC3);
    if (tjDecompress2(handle.get(), data, bytes.size(), image.data, width,
                      static_cast<int>(image.step), height, is_grey ? TJPF_GRAY : TJPF_RGB,
                      TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0)
        fail("it is a damaged or cut off JPEG ({})", tjGetErrorStr2(handle.get()));
    return image;
}

std::vector<std::byte> encode_jpeg(const cv::Mat& image) {
    const bool is_grey = image.type() == CV_8UC1;
    if (!is_grey && image.type() != CV_8UC3) fail("a JPEG does not take this picture");
    const Handle handle(tjInitCompress());
    if (!handle) fail("there is no memory for a JPEG");
    const int sampling = is_grey ? TJSAMP_GRAY : TJSAMP_420;
    std::vector<std::byte> bytes(tjBufSize(image.cols, image.rows, sampling));
    auto* data = reinterpret_cast<unsigned char*>(bytes.data());
    unsigned long size = bytes.size();
    if (tjCompress2(handle.get(), image.data, image.cols, static_cast<int>(image.step), image.rows,
                    is_grey ? TJPF_GRAY : TJPF_RGB, &data, &size, sampling, quality,
                    TJFLAG_NOREALLOC) != 0)
        fail("a JPEG cannot be made of this picture ({})", tjGetErrorStr2(handle.get()));
    bytes.resize(size);
    return bytes;
}

}  // namespace vantage
