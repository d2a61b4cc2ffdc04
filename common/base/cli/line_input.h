#pragma once

#include <optional>
#include <string>

namespace vantage {

/// Lines that a person types, or a script writes, taken as they come by a loop that also waits for
/// other things.
class LineInput {
  public:
    /// `fd` stays whose it is: 0 is standard input.
    explicit LineInput(int fd) : fd_(fd) {}

    int fd() const { return fd_; }
    /// Nothing more will come.
    bool is_at_end() const { return is_at_end_; }
    /// To be called when there is something to read; never waits otherwise. The next whole line
    /// without its end, of at most 1 KiB.
    std::optional<std::string> take();

  private:
    std::optional<std::string> next();

    int fd_;
    std::string text_;
    bool is_at_end_ = false;
};

}  // namespace vantage
