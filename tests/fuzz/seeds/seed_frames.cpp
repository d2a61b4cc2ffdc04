#include "tests/fuzz/seeds/seed_frames.h"

#include <algorithm>

namespace vantage {
namespace {

constexpr std::size_t header_length_bytes = 2;
constexpr std::size_t colour_length_bytes = 3;

std::span<const std::byte> take(std::span<const std::byte>& rest, std::size_t count) {
    const std::span<const std::byte> taken = rest.first(std::min(count, rest.size()));
    rest = rest.subspan(taken.size());
    return taken;
}

std::size_t take_length(std::span<const std::byte>& rest, std::size_t count) {
    std::size_t length = 0;
    std::size_t place = 0;
    for (const std::byte byte : take(rest, count))
        length |= std::to_integer<std::size_t>(byte) << (8 * place++);
    return length;
}

void append_length(std::vector<std::byte>& out, std::size_t length, std::size_t count) {
    for (std::size_t place = 0; place < count; ++place)
        out.push_back(static_cast<std::byte>(length >> (8 * place)));
}

}  // namespace

SeedParts split_frame(std::span<const std::byte> input) {
    const std::size_t header = take_length(input, header_length_bytes);
    const std::size_t colour = take_length(input, colour_length_bytes);
    SeedParts parts;
    parts.header = take(input, header);
    parts.colour = take(input, colour);
    parts.disparity = input;
    return parts;
}

std::vector<std::byte> join_frame(const PackedFrame& frame) {
    std::vector<std::byte> out;
    append_length(out, frame.header.size(), header_length_bytes);
    append_length(out, frame.colour.size(), colour_length_bytes);
    for (const auto* part : {&frame.header, &frame.colour, &frame.disparity})
        out.insert(out.end(), part->begin(), part->end());
    return out;
}

RigFrame seed_frame() {
    constexpr int width = 16;
    constexpr int height = 8;
    RigFrame frame;
    frame.rig = "rig-a";
    frame.session = 1;
    frame.synchronized = true;
    frame.trigger_index = 1000;
    frame.calibration_id = "c1";
    frame.geometry = {width, height, 300, 8, 8, 4, 0.1};
    frame.colour = ColourImage(height, width, cv::Vec4b(10, 20, 30, 255));
    frame.disparity = DisparityImage(height, width, std::uint16_t{320});
    frame.max_disparity_px = 64;
    return frame;
}

}  // namespace vantage
