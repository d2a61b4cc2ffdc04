#include "tests/support/data_folder.h"

#include <string>

#include <stdlib.h>

#include "common/base/error.h"

namespace vantage {

std::optional<std::filesystem::path> data_folder() {
    if (const char* folder = std::getenv("VANTAGE_DATA")) return std::filesystem::path(folder);
    const std::filesystem::path beside =
        std::filesystem::path(VANTAGE_SOURCE_DIR) / "../shared/data";
    if (std::filesystem::is_directory(beside)) return beside;
    return std::nullopt;
}

TemporaryFolder::TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "vantage-test-XXXXXX").string();
    if (!mkdtemp(pattern.data())) fail("cannot make a temporary folder {}", pattern);
    path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace vantage
