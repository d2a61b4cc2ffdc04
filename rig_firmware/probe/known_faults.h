#pragma once

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace vantage {

/// What decides which faults of kernels and drivers this computer has.
struct ComputerFacts {
    std::string model;                  ///< of the device tree; empty: no such board
    std::string kernel_release;         ///< "6.6.20+rpt-rpi-v8"
    bool has_triggered_imx296 = false;  ///< the sensor's driver waits for pulses
    std::string linuxptp_version;       ///< of the package; empty: not there
    bool has_one_step_ptp = false;      ///< rig.conf tells ptp4l twoStepFlag 0
};
ComputerFacts this_computer();

/// The first two or three numbers of a version; what is missing is 0. Versions compare as numbers.
struct VersionNumber {
    int major = 0, minor = 0, patch = 0;
    auto operator<=>(const VersionNumber&) const = default;
};
VersionNumber version_number(const std::string& text);

/// Whether a configuration of ptp4l sets twoStepFlag to 0: the last line that sets it holds.
bool sets_one_step(std::istream& ptp4l_configuration);

/// What is known of this very board, kernel and driver from public trackers: `unfit` spoils a rig
/// and says the mend, `notes` are to be known.
struct KnownFaults {
    std::vector<std::string> unfit, notes;
};
KnownFaults known_faults(const ComputerFacts& computer);

}  // namespace vantage
