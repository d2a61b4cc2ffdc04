#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/time/kernel_clock.h"

namespace vantage {

/// What ptp4l says of this computer's clock.
struct PtpState {
    std::string port_state;  ///< of its first port, as IEEE 1588 names it: "SLAVE", "MASTER", ...
    double offset_ns = 0;    ///< of this clock from its master
    double path_delay_ns = 0;
    int steps_removed = 0;  ///< from the grandmaster

    /// It follows a master, or is one that others follow.
    bool is_in_step() const { return port_state == "SLAVE" || port_state == "MASTER"; }
    /// And the system clock, which pulses go by, is in step with it: with hardware stamps ptp4l
    /// sets only the network interface's clock, and phc2sys carries that on.
    bool disciplines(const KernelClock& clock) const {
        return port_state == "MASTER" || (port_state == "SLAVE" && clock.was_set_lately);
    }
};

/// Where ptp4l listens for management messages, by its own default.
inline constexpr const char* ptp4l_socket = "/var/run/ptp4l";

/// Asks ptp4l through its management socket (PTP management messages of IEEE 1588, as `pmc` sends
/// them). Empty where no ptp4l answers within the timeout, or this user may not ask.
std::optional<PtpState> read_ptp4l(
    const std::filesystem::path& socket = ptp4l_socket,
    std::chrono::milliseconds timeout = std::chrono::milliseconds(200));

// The messages themselves.
enum class PtpDataSet : std::uint16_t { current = 0x2001, port = 0x2004 };
std::vector<std::byte> ptp_get_message(PtpDataSet data_set, std::uint16_t sequence);
/// Adds what the answer says to `state`; false if it is no answer to such a message.
bool read_ptp_answer(std::span<const std::byte> message, PtpDataSet data_set, PtpState& state);

}  // namespace vantage
