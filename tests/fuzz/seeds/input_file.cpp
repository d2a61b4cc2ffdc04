#include "tests/fuzz/seeds/input_file.h"

#include <cstdlib>
#include <string>

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/error.h"

namespace vantage {

InputFile::InputFile(std::span<const std::uint8_t> bytes)
    : fd_(memfd_create("fuzz-input", MFD_CLOEXEC)) {
    if (fd_ < 0 || ::fchmod(fd_, S_IRUSR | S_IWUSR) != 0 ||
        ::write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
        std::abort();
}

InputFile::~InputFile() { ::close(fd_); }

std::filesystem::path InputFile::path() const { return "/proc/self/fd/" + std::to_string(fd_); }

void expect_result_or_error(const std::function<void()>& decode) {
    try {
        decode();
    } catch (const Error& error) {
        // A sentence that names nothing helps nobody.
        if (std::string(error.what()).empty()) std::abort();
    }
}

}  // namespace vantage
