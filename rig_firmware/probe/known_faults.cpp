#include "rig_firmware/probe/known_faults.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <sys/utsname.h>

#include "rig_firmware/probe/probe.h"

namespace vantage {
namespace {

constexpr const char* trigger_parameter = "/sys/module/imx296/parameters/trigger_mode";
/// Configuration that vantage-ptp.service starts ptp4l with.
constexpr const char* ptp_configuration = "/etc/vantage/ptp/rig.conf";

// Each fault names the public tracker that describes it.
/// raspberrypi/linux#6010: merged in March 2024.
constexpr VersionNumber frame_ends_mended{6, 6, 20};
/// raspberrypi/linux#7515: from this version on, hardware time stamps of sent packets time out.
constexpr VersionNumber cm5_stamps_broken{6, 12, 0};
/// jclark/rpi-cm4-ptp-guide#33
constexpr VersionNumber two_step_default{4, 0, 0};

std::string line_of(const std::filesystem::path& path) {
    std::string line;
    std::getline(std::ifstream(path), line);
    while (!line.empty() && line.back() == '\0') line.pop_back();
    return line;
}

std::string installed_version(const std::string& package) {
    std::ifstream status("/var/lib/dpkg/status");
    bool is_it = false;
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("Package: ")) is_it = line == "Package: " + package;
        if (is_it && line.starts_with("Version: ")) return line.substr(9);
    }
    return {};
}

bool is(const ComputerFacts& computer, const char* board) {
    return computer.model.find(board) != std::string::npos;
}

}  // namespace

VersionNumber version_number(const std::string& text) {
    VersionNumber number;
    std::sscanf(text.c_str(), "%d.%d.%d", &number.major, &number.minor, &number.patch);
    return number;
}

bool sets_one_step(std::istream& ptp4l_configuration) {
    bool is_one_step = false;
    for (std::string line; std::getline(ptp4l_configuration, line);) {
        std::istringstream words(line);
        std::string key, value;
        if (words >> key >> value && key == "twoStepFlag") is_one_step = value == "0";
    }
    return is_one_step;
}

ComputerFacts this_computer() {
    ComputerFacts facts;
    facts.model = line_of("/proc/device-tree/model");
    utsname name{};
    if (::uname(&name) == 0) facts.kernel_release = name.release;
    const std::string mode = line_of(trigger_parameter);
    facts.has_triggered_imx296 = !mode.empty() && mode != "0";
    facts.linuxptp_version = installed_version("linuxptp");
    std::ifstream configuration(ptp_configuration);
    facts.has_one_step_ptp = sets_one_step(configuration);
    return facts;
}

KnownFaults known_faults(const ComputerFacts& computer) {
    KnownFaults known;
    const VersionNumber kernel = version_number(computer.kernel_release);
    if (computer.has_triggered_imx296) {
        if (kernel < frame_ends_mended)
            known.unfit.push_back(fmt::format(
                "kernel {} loses the ends of triggered frames of the IMX296 (raspberrypi/linux#6010"
                "): upgrade it to 6.6.20 or newer",
                computer.kernel_release));
        known.notes.emplace_back(
            "an IMX296 that waits for pulses does so until its power was off: unloading its driver "
            "is not enough (raspberrypi/linux#5560)");
        known.notes.emplace_back(
            "cameras with an IMX296 that waits for pulses are known to time out "
            "(raspberrypi/picamera2#748, raspberrypi/libcamera#56, #80)");
        known.notes.emplace_back(
            "an IMX296 may answer every other pulse only (raspberrypi/picamera2#783): compare the "
            "frames with the pulses, vantage rigs status");
        known.notes.emplace_back(
            "two IMX296 may be a frame apart (raspberrypi/picamera2#1116), and pictures 8 to 10 ms "
            "apart whose time stamps agree within 200 us (raspberrypi/picamera2#1107): prove it by "
            "their pictures, vantage-calib sync");
    }
    if (is(computer, "Raspberry Pi"))
        known.notes.emplace_back(
            "the processor reads a camera's dma-buf uncached on a Raspberry Pi, 20 rows in 6000 us "
            "instead of 200 (raspberrypi/linux#5286): let the GPU import it, or copy it once");
    if (is(computer, "Raspberry Pi 4"))
        known.notes.emplace_back(
            "a Raspberry Pi 4 has no hardware time stamps, whatever ethtool lists "
            "(raspberrypi/linux#5104): use rig-software.conf, vantage_ptp: software");
    if (is(computer, "Raspberry Pi 5"))
        known.notes.emplace_back(
            "a Raspberry Pi 5 stamps multicast PTP alone (raspberrypi/linux#5904): leave "
            "hybrid_e2e off");
    if (is(computer, "Compute Module 4") && !computer.has_one_step_ptp &&
        version_number(computer.linuxptp_version) >= two_step_default)
        known.unfit.push_back(
            fmt::format("linuxptp {} and a Compute Module 4 are in step only with twoStepFlag 0 "
                        "(jclark/rpi-cm4-ptp-guide#33): set it in {}, vantage_ptp_options: "
                        "{{twoStepFlag: 0}}",
                        computer.linuxptp_version, ptp_configuration));
    if (is(computer, "Compute Module 5")) {
        if (kernel >= cm5_stamps_broken)
            known.unfit.push_back(
                fmt::format("kernel {} loses hardware time stamps of a Compute Module 5 "
                            "(raspberrypi/linux#7515): take a kernel 6.6, or software stamps",
                            computer.kernel_release));
        known.notes.emplace_back(
            "a Compute Module 5 is 60 to 70 us off with delay_mechanism P2P "
            "(jclark/rpi-cm4-ptp-guide#49): use E2E");
    }
    return known;
}

ProbePart probe_known_faults() {
    const ComputerFacts computer = this_computer();
    KnownFaults known = known_faults(computer);
    ProbePart part{.title = "Board and kernel",
                   .facts = {{"model", computer.model},
                             {"kernel", computer.kernel_release},
                             {"linuxptp", computer.linuxptp_version},
                             {"one_step_ptp", computer.has_one_step_ptp},
                             {"notes", known.notes}},
                   .lines = {},
                   .unfit = std::move(known.unfit)};
    part.lines.push_back(fmt::format(
        "{}, kernel {}, linuxptp {}",
        computer.model.empty() ? "a computer without a device tree" : computer.model,
        computer.kernel_release,
        computer.linuxptp_version.empty() ? "not installed" : computer.linuxptp_version));
    part.lines.insert(part.lines.end(), known.notes.begin(), known.notes.end());
    return part;
}

}  // namespace vantage
