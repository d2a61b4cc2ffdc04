#include "common/image/netpbm.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>

#include "common/base/error.h"
#include "common/image/picture_size.h"

namespace vantage {
namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// The next number of the header, after spaces and comments.
std::uint64_t next_number(std::string_view& text) {
    while (!text.empty() && (is_space(text.front()) || text.front() == '#')) {
        if (text.front() == '#')
            text.remove_prefix(std::min(text.find('\n'), text.size()));
        else
            text.remove_prefix(1);
    }
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) fail("the header of the PGM or PPM is damaged");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

}  // namespace

cv::Mat decode_netpbm(std::span<const std::byte> bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const bool is_grey = text.starts_with("P5");
    if (!is_grey && !text.starts_with("P6")) fail("it is no PGM or PPM of bytes (P5, P6)");
    text.remove_prefix(2);
    const std::uint64_t width = next_number(text), height = next_number(text);
    require_picture_size(width, height);
    const std::uint64_t largest = next_number(text);
    constexpr std::uint64_t largest_byte = 255, largest_word = 65535;
    if (largest != largest_byte && largest != largest_word)
        fail("its largest value is {}; a PGM or PPM of {} or {} is taken", largest, largest_byte,
             largest_word);
    if (text.empty() || !is_space(text.front())) fail("the header of the PGM or PPM is damaged");
    text.remove_prefix(1);
    const bool is_wide = largest == largest_word;
    const auto type = CV_MAKETYPE(is_wide ? CV_16U : CV_8U, is_grey ? 1 : 3);
    const std::size_t size = width * height * static_cast<std::size_t>(CV_ELEM_SIZE(type));
    if (text.size() < size)
        fail("the PGM or PPM is damaged: {} of its {} bytes are missing", size - text.size(), size);
    cv::Mat image(static_cast<int>(height), static_cast<int>(width), type);
    std::memcpy(image.data, text.data(), size);
    // Words are big-endian.
    if (is_wide)
        for (std::size_t i = 0; i < size / 2; ++i) {
            std::uint16_t& word = reinterpret_cast<std::uint16_t*>(image.data)[i];
            word = __builtin_bswap16(word);
        }
    return image;
}

}  // namespace vantage
