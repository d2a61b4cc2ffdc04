#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>

#include "common/base/time/kernel_clock.h"
#include "rig_firmware/clock/ptp_state_file.h"
#include "rig_firmware/probe/probe.h"

namespace vantage {
namespace {

struct Clock {
    const char* name;
    clockid_t id;
};
constexpr std::array<Clock, 3> clocks = {{{"CLOCK_TAI", CLOCK_TAI},
                                          {"CLOCK_REALTIME", CLOCK_REALTIME},
                                          {"CLOCK_MONOTONIC", CLOCK_MONOTONIC}}};

std::string first_line(const std::filesystem::path& file) {
    std::string line;
    std::ifstream in(file);
    std::getline(in, line);
    return line;
}

void add_clocks(ProbePart& part) {
    for (const Clock& clock : clocks) {
        timespec resolution{};
        clock_getres(clock.id, &resolution);
        part.facts["resolution_ns"][clock.name] = resolution.tv_nsec;
        part.lines.push_back(fmt::format("{}: in steps of {} ns", clock.name, resolution.tv_nsec));
        if (resolution.tv_nsec > 1000)
            part.unfit.push_back(
                fmt::format("{} moves in steps of {} ns: the kernel has no high-resolution timers",
                            clock.name, resolution.tv_nsec));
    }
    const KernelClock kernel = read_kernel_clock();
    part.facts["tai_offset_s"] = kernel.tai_offset_s;
    part.facts["is_disciplined"] = kernel.is_synchronized;
    part.lines.push_back(fmt::format("TAI is {} s ahead of UTC; the system clock is {}",
                                     kernel.tai_offset_s,
                                     kernel.is_synchronized ? "disciplined" : "not disciplined"));
    if (kernel.tai_offset_s == 0)
        part.unfit.emplace_back(
            "CLOCK_TAI has no offset from UTC: set by ptp4l and phc2sys, or by chrony with a "
            "leapsectz; until then pulses agree only among computers that all lack it");
    if (!kernel.is_synchronized)
        part.unfit.emplace_back(
            "clocks not disciplined, skew unknown: neither PTP nor NTP has set this computer's "
            "clock");
}

void add_ptp(ProbePart& part) {
    part.facts["ptp_devices"] = nlohmann::json::array();
    std::error_code ignored;
    std::vector<std::filesystem::path> devices;
    for (const auto& entry : std::filesystem::directory_iterator("/sys/class/ptp", ignored))
        devices.push_back(entry.path());
    std::sort(devices.begin(), devices.end());
    for (const std::filesystem::path& device : devices) {
        const std::string node = "/dev/" + device.filename().string();
        const std::string name = first_line(device / "clock_name");
        part.facts["ptp_devices"].push_back({{"path", node}, {"name", name}});
        part.lines.push_back(fmt::format("{} '{}'", node, name));
    }
    const bool has_ptp4l = std::filesystem::is_socket(ptp4l_socket, ignored);
    const std::optional<PtpReading> reading = read_ptp();
    part.facts["ptp4l"] = {{"management_socket", ptp4l_socket}, {"is_there", has_ptp4l}};
    part.lines.push_back(fmt::format("ptp4l's management socket {}: {}", ptp4l_socket,
                                     has_ptp4l ? "there" : "not there"));
    if (reading) {
        const PtpState& state = reading->ptp;
        part.facts["ptp4l"]["port_state"] = state.port_state;
        part.facts["ptp4l"]["offset_ns"] = state.offset_ns;
        part.facts["ptp4l"]["path_delay_ns"] = state.path_delay_ns;
        part.lines.push_back(
            fmt::format("ptp4l is {}, {:.0f} ns from its master, path delay {:.0f} ns",
                        state.port_state, state.offset_ns, state.path_delay_ns));
        if (state.is_in_step() && !reading->is_disciplined())
            part.unfit.emplace_back(
                "ptp4l is in step, but nothing sets the system clock by it: with hardware stamps "
                "phc2sys has to run too (vantage-phc2sys.service)");
        if (!state.is_in_step())
            part.unfit.push_back(
                fmt::format("ptp4l is {} and follows no master: start ptp4l on the host, and let "
                            "multicast through the switch",
                            state.port_state));
    } else if (has_ptp4l) {
        part.unfit.push_back(
            fmt::format("ptp4l does not answer on {}: may this user write to it?", ptp4l_socket));
    } else {
        part.unfit.push_back(
            fmt::format("ptp4l does not run (no socket {}, no {}): rigs will not share one time",
                        ptp4l_socket, ptp_state_file));
    }
    if (devices.empty())
        part.unfit.emplace_back(
            "there is no PTP hardware clock: ptp4l can only stamp in software, to some tens of "
            "microseconds");
}

/// Tries real-time priority on a temporary thread, since a limit, a capability or a container may
/// each forbid it.
bool can_have_realtime_priority() {
    int refused = 0;
    std::thread([&] {
        const sched_param least{.sched_priority = ::sched_get_priority_min(SCHED_FIFO)};
        refused = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &least);
    }).join();
    return refused == 0;
}

/// Tries to lock memory in the same way as the trigger, since a limit or a capability may forbid
/// it.
bool can_lock_memory() {
    if (::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) return false;
    ::munlockall();
    return true;
}

void add_scheduling(ProbePart& part) {
    const bool is_realtime_kernel = first_line("/sys/kernel/realtime") == "1";
    rlimit priority{};
    ::getrlimit(RLIMIT_RTPRIO, &priority);
    const bool may_lock_all = can_lock_memory();
    const bool may_be_realtime = can_have_realtime_priority();
    part.facts["scheduling"] = {{"realtime_kernel", is_realtime_kernel},
                                {"may_have_realtime_priority", may_be_realtime},
                                {"realtime_priority_limit", priority.rlim_cur},
                                {"may_lock_all_memory", may_lock_all}};
    const auto yes_or_no = [](bool value) { return value ? "yes" : "no"; };
    part.lines.push_back(fmt::format(
        "real-time kernel: {}; real-time priority for this user: {}; may lock all memory: {}",
        yes_or_no(is_realtime_kernel), yes_or_no(may_be_realtime), yes_or_no(may_lock_all)));
    if (!may_be_realtime)
        part.unfit.emplace_back(
            "this user has no real-time priority, and pulses that it sends are late: start the rig "
            "by its systemd unit, which has leave for it, or raise the limit rtprio");
}

}  // namespace

ProbePart probe_clocks() {
    ProbePart part{.title = "Clocks", .facts = nlohmann::json::object(), .lines = {}, .unfit = {}};
    add_clocks(part);
    add_ptp(part);
    add_scheduling(part);
    return part;
}

}  // namespace vantage
