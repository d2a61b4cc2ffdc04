#include "host_app/output/picture_target.h"

#include <cerrno>
#include <cstring>

#include <unistd.h>

#include "common/base/error.h"

namespace vantage {

void require_picture_target(const std::filesystem::path& path, bool may_replace) {
    const std::string extension = path.extension().string();
    if (extension != ".png" && extension != ".jpg")
        fail("cannot write {}: a picture is a .png or .jpg file, not '{}'", path.string(),
             extension);
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        fail("cannot write {}: it is a folder", path.string());
    if (!may_replace && std::filesystem::exists(path, ignored))
        fail(
            "{} is there already, and a picture is not replaced without being asked: take another "
            "name, or --overwrite",
            path.string());
    const std::filesystem::path folder =
        path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (access(folder.c_str(), W_OK) != 0)
        fail("cannot write {}: its folder: {}", path.string(), std::strerror(errno));
}

}  // namespace vantage
