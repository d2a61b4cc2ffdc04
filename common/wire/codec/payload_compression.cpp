#include "common/wire/codec/payload_compression.h"

#include <new>

#include "common/base/error.h"

namespace vantage {
namespace {

/// zstd's fastest level: higher ones take several times as long on a Raspberry Pi to save a few
/// percent.
constexpr int compression_level = 1;

}  // namespace

PayloadCompressor::PayloadCompressor() : context_(ZSTD_createCCtx()) {
    if (!context_) throw std::bad_alloc();
}

PayloadCompressor::~PayloadCompressor() { ZSTD_freeCCtx(context_); }

std::vector<std::byte> PayloadCompressor::compress(std::span<const std::byte> raw) {
    std::vector<std::byte> payload(ZSTD_compressBound(raw.size()));
    const std::size_t size = ZSTD_compressCCtx(context_, payload.data(), payload.size(), raw.data(),
                                               raw.size(), compression_level);
    if (ZSTD_isError(size))
        fail("zstd cannot compress an image of {} bytes: {}", raw.size(), ZSTD_getErrorName(size));
    payload.resize(size);
    return payload;
}

PayloadDecompressor::PayloadDecompressor() : context_(ZSTD_createDCtx()) {
    if (!context_) throw std::bad_alloc();
}

PayloadDecompressor::~PayloadDecompressor() { ZSTD_freeDCtx(context_); }

std::span<const std::byte> PayloadDecompressor::decompress(std::span<const std::byte> payload,
                                                           std::size_t raw_bytes,
                                                           std::string_view what) {
    const unsigned long long claimed = ZSTD_getFrameContentSize(payload.data(), payload.size());
    if (claimed == ZSTD_CONTENTSIZE_ERROR || claimed == ZSTD_CONTENTSIZE_UNKNOWN)
        fail("the {} payload is not a zstd frame that states its size", what);
    if (claimed != raw_bytes)
        fail("the {} payload holds {} bytes where its header promises {}", what, claimed,
             raw_bytes);
    raw_.resize(raw_bytes);
    const std::size_t size =
        ZSTD_decompressDCtx(context_, raw_.data(), raw_.size(), payload.data(), payload.size());
    if (ZSTD_isError(size))
        fail("the {} payload of {} bytes is damaged: {}", what, payload.size(),
             ZSTD_getErrorName(size));
    if (size != raw_bytes)
        fail("the {} payload gave {} bytes where its header promises {}", what, size, raw_bytes);
    return raw_;
}

}  // namespace vantage
