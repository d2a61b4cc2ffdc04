#include "tests/bench/support/markdown_tables.h"

#include <span>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"

namespace vantage {

void put_between_markers(const std::filesystem::path& file, const std::string& tables) {
    constexpr std::string_view begin_marker = "<!-- measured: begin -->\n",
                               end_marker = "<!-- measured: end -->";
    constexpr std::size_t max_bytes = std::size_t{1} << 20;
    const std::vector<std::byte> bytes = read_file(file, max_bytes);
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t begin = text.find(begin_marker), end = text.find(end_marker);
    if (begin == std::string::npos || end == std::string::npos || end < begin)
        fail("{} lacks the lines '{}' and '{}'; put them where the tables go", file.string(),
             begin_marker.substr(0, begin_marker.size() - 1), end_marker);
    text.replace(begin + begin_marker.size(), end - begin - begin_marker.size(), tables + "\n");
    write_file_atomically(file, std::as_bytes(std::span(text)));
}

}  // namespace vantage
