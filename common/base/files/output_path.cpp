#include "common/base/files/output_path.h"

#include <cerrno>
#include <cstring>
#include <ctime>

#include <unistd.h>

#include "common/base/error.h"

namespace vantage {
namespace {

/// Whether two paths name the same file, also if the file does not exist yet.
bool are_the_same(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code ignored;
    if (std::filesystem::equivalent(a, b, ignored)) return true;
    return std::filesystem::weakly_canonical(a, ignored) ==
           std::filesystem::weakly_canonical(b, ignored);
}

}  // namespace

void require_writable_output(const std::filesystem::path& output,
                             std::initializer_list<std::filesystem::path> others) {
    for (const std::filesystem::path& other : others)
        if (are_the_same(output, other))
            fail("{} would be overwritten: it is {} too; give the output another name",
                 output.string(), other.string());
    std::error_code ignored;
    if (std::filesystem::is_directory(output, ignored))
        fail("cannot write {}: it is a folder", output.string());
    const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : ".";
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        fail("cannot write {}: {}", output.string(), std::strerror(errno));
}

std::filesystem::path free_path(const std::filesystem::path& path) {
    std::filesystem::path free = path;
    for (int number = 2; std::filesystem::exists(free); ++number)
        free = path.parent_path() /
               fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string());
    return free;
}

std::filesystem::path name_for_now(const std::string& stem, const std::string& extension) {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    localtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "-%Y-%m-%d-%H%M%S", &parts);
    return stem + text + extension;
}

}  // namespace vantage
