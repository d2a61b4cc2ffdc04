#include "common/base/files/folder.h"

#include <cstdlib>
#include <system_error>

#include "common/base/error.h"

namespace vantage {

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        fail("cannot make the folder {} ({}); give one that can be written", folder.string(),
             error.message());
}

std::filesystem::path user_folder() {
    if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder && *folder)
        return std::filesystem::path(folder) / "vantage";
    const char* home = std::getenv("HOME");
    if (!home || !*home) fail("this user has no home: set HOME or XDG_CONFIG_HOME");
    return std::filesystem::path(home) / ".config/vantage";
}

}  // namespace vantage
