#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace vantage {

/// What a user, a file, a device or the network can cause. what() is one clear sentence for a
/// person: it names the thing, the limit it broke and the mend. Thrown where the fault is found and
/// caught at the edges only: main(), the top of a thread, and the boundary of one message in a
/// message loop. Programming mistakes are asserts, never an Error.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The work was done, and what it was to find out cannot be told from what there is: a status of
/// its own (run_program), so that nobody's script takes it for a yes or for a fault.
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
