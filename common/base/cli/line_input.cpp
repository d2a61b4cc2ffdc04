#include "common/base/cli/line_input.h"

#include <array>
#include <cerrno>

#include <poll.h>
#include <unistd.h>

namespace vantage {

std::optional<std::string> LineInput::take() {
    constexpr std::size_t longest_line = 1024;
    if (auto line = next()) return line;
    pollfd readable{fd_, POLLIN, 0};
    if (is_at_end_ || ::poll(&readable, 1, 0) <= 0) return std::nullopt;
    std::array<char, longest_line> buffer{};
    const ssize_t count = ::read(fd_, buffer.data(), buffer.size());
    if (count > 0) {
        text_.append(buffer.data(), static_cast<std::size_t>(count));
        // Longer than any typed line: a file was piped in. Discard it.
        if (text_.size() > longest_line && text_.find('\n') == std::string::npos) text_.clear();
    } else if (count == 0 || errno != EINTR) {
        is_at_end_ = true;
    }
    return next();
}

std::optional<std::string> LineInput::next() {
    const std::size_t end = text_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
}

}  // namespace vantage
