#include "common/image/netpbm.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>

#include "common/base/error.h"
#include "common/image/picture_size.h"

namespace vantage {
namespace {

constexpr std::uint64_t white_byte = 255, largest_word = 65535;

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

void skip_spaces_and_comments(std::string_view& text) {
    while (!text.empty() && (is_space(text.front()) || text.front() == '#')) {
        if (text.front() == '#')
            text.remove_prefix(std::min(text.find_first_of("\r\n"), text.size()));
        else
            text.remove_prefix(1);
    }
}

/// The next number of the header, after spaces and comments.
std::uint64_t next_number(std::string_view& text) {
    skip_spaces_and_comments(text);
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) fail("the header of the PGM or PPM is damaged");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

/// The next sample of a plain picture; those of a PBM are digits that need no space between them.
std::uint64_t next_plain_sample(std::string_view& text, bool is_bitmap, std::uint64_t largest) {
    skip_spaces_and_comments(text);
    std::uint64_t sample = 0;
    const std::string_view digits = is_bitmap ? text.substr(0, 1) : text;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), sample);
    if (text.empty()) fail("the plain PGM or PPM is cut off: samples are missing at its end");
    if (error != std::errc()) fail("a sample of the plain PGM or PPM is no number");
    if (sample > largest)
        fail("a sample is {} where the header allows at most {}", sample, largest);
    text.remove_prefix(static_cast<std::size_t>(end - digits.data()));
    return sample;
}

struct Layout {
    int rows = 0, samples_a_row = 0;
    bool is_bitmap = false, is_wide = false;
    std::uint64_t largest = 0;
};

void put(cv::Mat& image, int row, int sample, std::uint64_t code, const Layout& layout) {
    if (layout.is_bitmap)
        image.ptr<std::uint8_t>(row)[sample] = code == 0 ? white_byte : 0;
    else if (layout.is_wide)
        image.ptr<std::uint16_t>(row)[sample] = static_cast<std::uint16_t>(code);
    else
        image.ptr<std::uint8_t>(row)[sample] = static_cast<std::uint8_t>(code);
}

void read_plain(std::string_view text, const Layout& layout, cv::Mat& image) {
    for (int y = 0; y < layout.rows; ++y)
        for (int i = 0; i < layout.samples_a_row; ++i)
            put(image, y, i, next_plain_sample(text, layout.is_bitmap, layout.largest), layout);
}

void read_bytes(std::string_view text, const Layout& layout, cv::Mat& image) {
    const auto samples = static_cast<std::size_t>(layout.samples_a_row);
    const std::size_t row_bytes = layout.is_bitmap ? (samples + 7) / 8
                                  : layout.is_wide ? 2 * samples
                                                   : samples;
    const std::size_t size = row_bytes * static_cast<std::size_t>(layout.rows);
    if (text.size() < size)
        fail("the PGM or PPM is damaged: {} of its {} bytes are missing", size - text.size(), size);
    for (int y = 0; y < layout.rows; ++y) {
        const auto* row = reinterpret_cast<const std::uint8_t*>(text.data()) +
                          row_bytes * static_cast<std::size_t>(y);
        for (int i = 0; i < layout.samples_a_row; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const std::uint64_t code = layout.is_bitmap ? (row[at / 8] >> (7 - at % 8) & 1)
                                       : layout.is_wide ? (row[2 * at] << 8 | row[2 * at + 1])
                                                        : row[at];
            if (code > layout.largest)
                fail("a sample is {} where the header allows at most {}", code, layout.largest);
            put(image, y, i, code, layout);
        }
    }
}

}  // namespace

NetpbmPicture decode_netpbm(std::span<const std::byte> bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.size() < 2 || text[0] != 'P' || text[1] < '1' || text[1] > '6')
        fail("it is no PBM, PGM or PPM (P1 to P6)");
    const bool is_plain = text[1] <= '3';
    const int kind = (text[1] - '1') % 3;  // bitmap, grey, colour
    text.remove_prefix(2);
    const std::uint64_t width = next_number(text), height = next_number(text);
    require_picture_size(width, height);
    Layout layout;
    layout.is_bitmap = kind == 0;
    layout.largest = layout.is_bitmap ? 1 : next_number(text);
    if (layout.largest < 1 || layout.largest > largest_word)
        fail("its largest value is {}; 1 to {} are possible", layout.largest, largest_word);
    if (text.empty() || !is_space(text.front())) fail("the header of the PGM or PPM is damaged");
    text.remove_prefix(1);
    const int channels = kind == 2 ? 3 : 1;
    layout.is_wide = layout.largest > white_byte;
    layout.rows = static_cast<int>(height);
    layout.samples_a_row = static_cast<int>(width) * channels;
    // Each sample takes a digit at least.
    if (is_plain && text.size() < width * height * static_cast<std::size_t>(channels))
        fail("the plain PGM or PPM is cut off: samples are missing at its end");
    NetpbmPicture picture;
    picture.largest_code = static_cast<int>(layout.is_bitmap ? white_byte : layout.largest);
    picture.image.create(layout.rows, static_cast<int>(width),
                         CV_MAKETYPE(layout.is_wide ? CV_16U : CV_8U, channels));
    if (is_plain)
        read_plain(text, layout, picture.image);
    else
        read_bytes(text, layout, picture.image);
    return picture;
}

}  // namespace vantage
