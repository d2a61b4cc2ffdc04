#include "common/wire/codec/colour_codec.h"

#include <new>
#include <string>
#include <utility>

#include <turbojpeg.h>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr int channels = 4;

int sampling_of(Chroma chroma) {
    switch (chroma) {
        case Chroma::full:
            return TJSAMP_444;
        case Chroma::half:
            return TJSAMP_422;
        case Chroma::quarter:
            break;
    }
    return TJSAMP_420;
}

}  // namespace

JpegEncoder::JpegEncoder() : compressor_(tjInitCompress()) {
    if (!compressor_) throw std::bad_alloc();
}

JpegEncoder::~JpegEncoder() { tjDestroy(compressor_); }

std::vector<std::byte> JpegEncoder::encode(const ColourImage& colour, int quality, Chroma chroma) {
    const int sampling = sampling_of(chroma);
    std::vector<std::byte> payload(tjBufSize(colour.cols, colour.rows, sampling));
    auto* data = reinterpret_cast<unsigned char*>(payload.data());
    unsigned long size = payload.size();
    if (tjCompress2(compressor_, colour.data, colour.cols, static_cast<int>(colour.step),
                    colour.rows, TJPF_RGBA, &data, &size, sampling, quality, TJFLAG_NOREALLOC) != 0)
        fail("a colour picture of {}x{} cannot be packed as JPEG: {}", colour.cols, colour.rows,
             tjGetErrorStr2(compressor_));
    payload.resize(size);
    return payload;
}

JpegDecoder::JpegDecoder() : decompressor_(tjInitDecompress()) {
    if (!decompressor_) throw std::bad_alloc();
}

JpegDecoder::~JpegDecoder() { tjDestroy(decompressor_); }

std::string JpegDecoder::trouble() {
    std::string sentence = tjGetErrorStr2(decompressor_);
    if (void* fresh = tjInitDecompress()) tjDestroy(std::exchange(decompressor_, fresh));
    return sentence;
}

ColourImage JpegDecoder::decode(std::span<const std::byte> payload, int width_px, int height_px,
                                ColourImage memory) {
    const auto* data = reinterpret_cast<const unsigned char*>(payload.data());
    int width = 0;
    int height = 0;
    int subsampling = 0;
    int colour_space = 0;
    if (tjDecompressHeader3(decompressor_, data, payload.size(), &width, &height, &subsampling,
                            &colour_space) != 0)
        fail("the colour payload is not a JPEG picture: {}", trouble());
    if (width != width_px || height != height_px)
        fail("the colour payload is a JPEG of {}x{} where its header promises {}x{}", width, height,
             width_px, height_px);
    if (colour_space != TJCS_YCbCr) fail("the colour payload is a JPEG, but not in YCbCr");
    ColourImage colour =
        memory.empty() ? pictures_.take<ColourImage>({width_px, height_px}) : std::move(memory);
    // The library only warns about a truncated image and fills it with grey. The scan limit stops
    // a hostile progressive image with endless scans.
    if (tjDecompress2(decompressor_, data, payload.size(), colour.data, width_px,
                      static_cast<int>(colour.step), height_px, TJPF_RGBA,
                      TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0)
        fail("the colour payload of {} bytes is damaged: {}", payload.size(), trouble());
    return colour;
}

Chroma JpegDecoder::chroma_of(std::span<const std::byte> payload) {
    int width = 0, height = 0, subsampling = 0, colour_space = 0;
    if (tjDecompressHeader3(decompressor_, reinterpret_cast<const unsigned char*>(payload.data()),
                            payload.size(), &width, &height, &subsampling, &colour_space) != 0)
        fail("the colour payload is not a JPEG picture: {}", trouble());
    for (const Chroma chroma : {Chroma::full, Chroma::half, Chroma::quarter})
        if (subsampling == sampling_of(chroma)) return chroma;
    fail("the colour payload is a JPEG whose chroma is not 4:4:4, 4:2:2 or 4:2:0");
}

std::vector<std::byte> LosslessColourEncoder::encode(const ColourImage& colour) {
    const std::size_t count = colour.total();
    planes_.resize(channels * count);
    std::byte* out = planes_.data();
    const std::vector<cv::Vec4b> nothing_above(static_cast<std::size_t>(colour.cols));
    for (int channel = 0; channel < channels; ++channel) {
        const cv::Vec4b* above = nothing_above.data();
        for (int y = 0; y < colour.rows; ++y) {
            const cv::Vec4b* row = colour[y];
            for (int x = 0; x < colour.cols; ++x)
                *out++ = static_cast<std::byte>(row[x][channel] - above[x][channel]);
            above = row;
        }
    }
    return compressor_.compress(planes_);
}

ColourImage LosslessColourDecoder::decode(std::span<const std::byte> payload, int width_px,
                                          int height_px) {
    const std::size_t count =
        static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
    const std::byte* in = decompressor_.decompress(payload, channels * count, "colour").data();
    auto colour = pictures_.take<ColourImage>({width_px, height_px});
    const std::vector<cv::Vec4b> nothing_above(static_cast<std::size_t>(width_px));
    for (int channel = 0; channel < channels; ++channel) {
        const cv::Vec4b* above = nothing_above.data();
        for (int y = 0; y < height_px; ++y) {
            cv::Vec4b* row = colour[y];
            for (int x = 0; x < width_px; ++x)
                row[x][channel] =
                    static_cast<std::uint8_t>(above[x][channel] + std::to_integer<unsigned>(*in++));
            above = row;
        }
    }
    return colour;
}

}  // namespace vantage
