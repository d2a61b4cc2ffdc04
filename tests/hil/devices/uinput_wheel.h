#pragma once

#include <cstdint>

#include "common/base/files/unique_fd.h"

namespace vantage {

/// A Griffin PowerMate as the kernel's own driver shows it: an input device (uinput) with a dial
/// and a button. Its end is the unplugging.
class UinputWheel {
  public:
    UinputWheel();

    /// One turn of the dial, or the button's being held or let go.
    void turn(int steps) const;
    void press(bool held) const;

  private:
    void send(std::uint16_t type, std::uint16_t code, int value) const;

    UniqueFd fd_;
};

}  // namespace vantage
