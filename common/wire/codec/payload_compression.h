#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <zstd.h>

namespace vantage {

/// Compresses to one zstd frame that states its content size. Keeps its context between calls. Not
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

/// Decompresses one zstd frame. Not thread-safe.
class PayloadDecompressor {
  public:
    PayloadDecompressor();
    ~PayloadDecompressor();
    PayloadDecompressor(const PayloadDecompressor&) = delete;
    PayloadDecompressor& operator=(const PayloadDecompressor&) = delete;

    /// Returns a buffer that is valid until the next call. Throws Error, naming `what`, unless the
    /// payload is complete and contains exactly raw_bytes. Checks the stated size before it
    /// allocates memory.
    std::span<const std::byte> decompress(std::span<const std::byte> payload, std::size_t raw_bytes,
                                          std::string_view what);

  private:
    ZSTD_DCtx* context_;
    std::vector<std::byte> raw_;
};

}  // namespace vantage
