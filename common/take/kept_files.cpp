#include "common/take/kept_files.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace vantage {

std::string kept_file_name(const std::string& rig, std::time_t begin) {
    std::tm parts{};
    gmtime_r(&begin, &parts);
    char text[40];
    std::strftime(text, sizeof text, "%Y%m%dT%H%M%SZ", &parts);
    return fmt::format("{}-{}.mkv", rig, text);
}

std::optional<std::time_t> begin_of_kept_file(const std::filesystem::path& path,
                                              const std::string& rig) {
    const std::string name = path.filename().string();
    if (!name.starts_with(rig + "-") || path.extension() != ".mkv") return std::nullopt;
    // A second file of the same second has the suffix "-2".
    std::tm parts{};
    if (!strptime(name.c_str() + rig.size() + 1, "%Y%m%dT%H%M%SZ", &parts)) return std::nullopt;
    return timegm(&parts);
}

std::vector<KeptFile> kept_files(const std::filesystem::path& folder, const std::string& rig) {
    std::vector<KeptFile> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (!begin_of_kept_file(entry.path(), rig)) continue;
        const auto written = entry.last_write_time(error);
        const std::uint64_t bytes = error ? 0 : entry.file_size(error);
        if (!error) files.push_back({entry.path(), written, bytes});
    }
    std::sort(files.begin(), files.end(), [](const KeptFile& a, const KeptFile& b) {
        return std::tie(a.written, a.path) < std::tie(b.written, b.path);
    });
    return files;
}

}  // namespace vantage
