#include "common/base/child_log.h"

#include <algorithm>
#include <fstream>
#include <string_view>

namespace vantage {

std::string last_sentence_of(const std::filesystem::path& log) {
    constexpr std::streamoff tail_bytes = 1 << 16;
    std::ifstream file(log, std::ios::binary | std::ios::ate);
    if (!file) return {};
    const std::streamoff size = file.tellg();
    file.seekg(std::max<std::streamoff>(0, size - tail_bytes));
    std::string last;
    for (std::string line; std::getline(file, line);)
        if (!line.empty()) last = line;
    constexpr std::string_view level = ": error: ";
    if (const std::size_t at = last.find(level); at != std::string::npos)
        last.erase(0, at + level.size());
    return last;
}

std::vector<std::string> warnings_in(const std::filesystem::path& log) {
    constexpr std::string_view level = ": warning: ";
    std::ifstream file(log, std::ios::binary);
    std::vector<std::string> warnings;
    for (std::string line; std::getline(file, line);)
        if (const std::size_t at = line.find(level); at != std::string::npos)
            warnings.push_back(line.substr(at + level.size()));
    return warnings;
}

}  // namespace vantage
