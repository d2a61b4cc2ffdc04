#include "common/image/pfm.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

constexpr std::size_t max_header_bytes = 128;
constexpr std::size_t max_pfm_bytes =
    std::size_t{max_image_side_px} * max_image_side_px * sizeof(float) + max_header_bytes;

}  // namespace

cv::Mat1f read_pfm(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = read_file(path, max_pfm_bytes);
    // The header is three lines of text; whatever follows the newline after the scale is samples.
    const std::string head(reinterpret_cast<const char*>(bytes.data()),
                           std::min(bytes.size(), max_header_bytes));
    std::istringstream in(head);
    std::string magic;
    int width = 0, height = 0;
    double scale = 0;
    if (!(in >> magic) || magic != "Pf")
        fail("{} is not a one-channel PFM file (its first word must be Pf)", path.string());
    if (!(in >> width >> height >> scale) || width < 1 || height < 1 || scale == 0 ||
        !std::isfinite(scale))
        fail("{} has a damaged PFM header (width, height and a non-zero scale are expected)",
             path.string());
    if (width > max_image_side_px || height > max_image_side_px)
        fail("{} is {}x{}; pictures up to {} pixels a side are taken", path.string(), width, height,
             max_image_side_px);
    // A file that ends with the scale has no samples at all, and no place where they would start.
    std::size_t start = in.eof() ? bytes.size() : static_cast<std::size_t>(in.tellg()) + 1;
    const std::size_t row_bytes = static_cast<std::size_t>(width) * sizeof(float);
    // Some writers end the header with CR LF, or with blanks. A sample may begin with such a byte
    // too, so the file's size decides.
    const std::size_t whole = row_bytes * static_cast<std::size_t>(height);
    if (bytes.size() > start + whole && bytes.size() < max_header_bytes + whole) {
        const std::string_view surplus(head.data() + start, bytes.size() - start - whole);
        if (surplus.find_first_not_of(" \t\r\n") == std::string_view::npos) start += surplus.size();
    }
    if (bytes.size() < start ||
        bytes.size() - start != row_bytes * static_cast<std::size_t>(height))
        fail("{} should hold {} bytes of samples for {}x{} and holds {}", path.string(),
             row_bytes * static_cast<std::size_t>(height), width, height,
             bytes.size() < start ? 0 : bytes.size() - start);
    cv::Mat1f image(height, width);
    const bool file_is_little = scale < 0;
    const bool swap = file_is_little != (std::endian::native == std::endian::little);
    for (int y = 0; y < height; ++y) {
        float* row = image.ptr<float>(height - 1 - y);
        std::memcpy(row, bytes.data() + start + row_bytes * static_cast<std::size_t>(y), row_bytes);
        if (!swap) continue;
        for (int x = 0; x < width; ++x) {
            auto word = std::bit_cast<std::uint32_t>(row[x]);
            row[x] = std::bit_cast<float>(__builtin_bswap32(word));
        }
    }
    return image;
}

void write_pfm(const std::filesystem::path& path, const cv::Mat1f& image) {
    static_assert(std::endian::native == std::endian::little, "PFM is written in native order");
    const std::string header = fmt::format("Pf\n{} {}\n-1.0\n", image.cols, image.rows);
    const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * sizeof(float);
    std::vector<std::byte> bytes(header.size() + row_bytes * static_cast<std::size_t>(image.rows));
    std::memcpy(bytes.data(), header.data(), header.size());
    for (int y = 0; y < image.rows; ++y)
        std::memcpy(bytes.data() + header.size() + row_bytes * static_cast<std::size_t>(y),
                    image.ptr<float>(image.rows - 1 - y), row_bytes);
    write_file_atomically(path, bytes);
}

}  // namespace vantage
