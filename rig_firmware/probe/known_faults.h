#pragma once

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace vantage {

/// Properties of this computer that decide which known kernel and driver faults it has.
struct ComputerFacts {
    std::string model;                  ///< from the device tree; empty if there is none
    std::string kernel_release;         ///< "6.6.20+rpt-rpi-v8"
    bool has_triggered_imx296 = false;  ///< the driver of the sensor waits for pulses
    std::string linuxptp_version;       ///< version of the package; empty if it is not installed
    bool has_one_step_ptp = false;      ///< rig.conf tells ptp4l twoStepFlag 0
};
ComputerFacts this_computer();

/// First two or three numbers of a version; missing ones are 0. Versions compare number by number.
struct VersionNumber {
    int major = 0, minor = 0, patch = 0;
    auto operator<=>(const VersionNumber&) const = default;
};
VersionNumber version_number(const std::string& text);

/// True if this ptp4l configuration sets twoStepFlag to 0. The last line that sets the flag counts.
bool sets_one_step(std::istream& ptp4l_configuration);

/// Known faults of this board, kernel and drivers, from public trackers. `unfit` faults make a rig
/// unusable and name the mend; `notes` are for information.
struct KnownFaults {
    std::vector<std::string> unfit, notes;
};
KnownFaults known_faults(const ComputerFacts& computer);

}  // namespace vantage
