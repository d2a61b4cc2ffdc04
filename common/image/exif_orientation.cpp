#include "common/image/exif_orientation.h"

#include <array>
#include <cstdint>

namespace vantage {
namespace {

constexpr int upright = 1, largest_orientation = 8;

/// Reads the integers of a TIFF file, in the byte order that its header states.
class TiffReader {
  public:
    explicit TiffReader(std::span<const std::byte> bytes)
        : bytes_(bytes), is_little_(bytes.size() > 1 && bytes[0] == std::byte{'I'}) {}

    bool has(std::size_t at, std::size_t count) const {
        return at <= bytes_.size() && count <= bytes_.size() - at;
    }
    /// Precondition: has(at, count), count <= 4.
    std::uint32_t integer(std::size_t at, std::size_t count) const {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t next = at + (is_little_ ? count - 1 - i : i);
            value = value << 8 | std::to_integer<std::uint32_t>(bytes_[next]);
        }
        return value;
    }

  private:
    std::span<const std::byte> bytes_;
    bool is_little_;
};

}  // namespace

int exif_orientation(std::span<const std::byte> tiff) {
    constexpr std::uint32_t tiff_version = 42, orientation_tag = 0x0112, type_short = 3;
    constexpr std::size_t header_bytes = 8, entry_bytes = 12;
    const TiffReader reader(tiff);
    if (!reader.has(0, header_bytes) || tiff[0] != tiff[1] ||
        (tiff[0] != std::byte{'I'} && tiff[0] != std::byte{'M'}) ||
        reader.integer(2, 2) != tiff_version)
        return upright;
    const std::size_t directory = reader.integer(4, 4);
    if (!reader.has(directory, 2)) return upright;
    const std::size_t entries = reader.integer(directory, 2);
    for (std::size_t i = 0; i < entries; ++i) {
        const std::size_t entry = directory + 2 + i * entry_bytes;
        if (!reader.has(entry, entry_bytes)) return upright;
        if (reader.integer(entry, 2) != orientation_tag) continue;
        const auto value = static_cast<int>(
            reader.integer(entry + 8, reader.integer(entry + 2, 2) == type_short ? 2 : 4));
        return value >= upright && value <= largest_orientation ? value : upright;
    }
    return upright;
}

std::string orientation_in_words(int orientation) {
    static constexpr std::array words{"as it is stored",
                                      "mirrored left to right",
                                      "turned by 180 degrees",
                                      "mirrored top to bottom",
                                      "mirrored and turned by 90 degrees anticlockwise",
                                      "turned by 90 degrees clockwise",
                                      "mirrored and turned by 90 degrees clockwise",
                                      "turned by 90 degrees anticlockwise"};
    const bool is_known = orientation >= upright && orientation <= largest_orientation;
    return words[static_cast<std::size_t>(is_known ? orientation - 1 : 0)];
}

}  // namespace vantage
