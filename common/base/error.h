#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace vantage {

/// A fault that a user, a file, a device or the network caused. what() is one clear sentence that
/// names the thing, the limit and the mend. Errors are caught at the edges only: in main(), at the
/// top of a thread, and around one message of a message loop. Programming mistakes are asserts.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A check ran, but its input does not decide the question. It has an exit status of its own
/// (run_program), so that scripts do not mistake it for a pass or a fault.
class Undecided : public Error {
  public:
    using Error::Error;
};

/// Throws Error with a formatted sentence.
template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace vantage
