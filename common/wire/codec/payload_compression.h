#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <zstd.h>

namespace vantage {

/// One zstd frame of level 1 that states its content size; the context is kept between calls. Not
/// thread-safe.
class PayloadCompressor {
  public:
    PayloadCompressor();
    ~PayloadCompressor();
    PayloadCompressor(const PayloadCompressor&) = delete;
    PayloadCompressor& operator=(const PayloadCompressor&) = delete;

    std::vector<std::byte> compress(std::span<const std::byte> raw);

  private:
    ZSTD_CCtx* context_;
};

/// The way back. Not thread-safe.
class PayloadDecompressor {
  public:
    PayloadDecompressor();
    ~PayloadDecompressor();
    PayloadDecompressor(const PayloadDecompressor&) = delete;
    PayloadDecompressor& operator=(const PayloadDecompressor&) = delete;

    /// Into a buffer of its own that lives until the next call. Throws Error, naming `what`, unless
    /// the payload is whole and holds exactly raw_bytes; what it claims is checked before memory is
    /// taken.
    std::span<const std::byte> decompress(std::span<const std::byte> payload, std::size_t raw_bytes,
                                          std::string_view what);

  private:
    ZSTD_DCtx* context_;
    std::vector<std::byte> raw_;
};

}  // namespace vantage
