#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/wire/frame_codec.h"

namespace vantage {

/// The input of frame_decoder_fuzz: three parts behind each other, the length of the first two as
/// two and three bytes, little-endian, before them. Any bytes mean something.
struct SeedParts {
    std::span<const std::byte> header, colour, disparity;
};
SeedParts split_frame(std::span<const std::byte> input);
std::vector<std::byte> join_frame(const PackedFrame& frame);

/// A small good frame.
RigFrame seed_frame();

}  // namespace vantage
