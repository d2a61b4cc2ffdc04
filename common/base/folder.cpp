#include "common/base/folder.h"

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

}  // namespace vantage
