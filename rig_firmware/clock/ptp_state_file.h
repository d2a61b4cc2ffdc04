#pragma once

#include <filesystem>
#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "common/base/time/kernel_clock.h"
#include "common/base/time/time.h"
#include "rig_firmware/clock/ptp4l_client.h"

namespace vantage {

/// How this computer's clock stands: ptp4l's word and the kernel's.
struct PtpReading {
    PtpState ptp;
    KernelClock kernel;

    bool is_disciplined() const { return ptp.disciplines(kernel); }
};

/// Where `vantage-rig ptp-state` keeps the newest reading, for a daemon that may neither write to
/// ptp4l's socket, which would let it change what ptp4l does, nor ask the kernel.
inline constexpr const char* ptp_state_file = "/run/vantage-ptp/state.json";

/// A reading older than this is of no worth: whoever wrote it has ended or hangs.
inline constexpr std::chrono::seconds ptp_state_lifetime(5);

/// As the state file has it; without a reading, `port_state` is null and there is no more.
nlohmann::ordered_json to_json(const std::optional<PtpReading>& reading, MonotonicTime now);

/// Throws Error if the file cannot be written.
void write_ptp_state(const std::filesystem::path& file, const PtpReading& reading,
                     MonotonicTime now);
/// Empty where there is no such file, or it is old or damaged.
std::optional<PtpReading> read_ptp_state(const std::filesystem::path& file, MonotonicTime now);

/// The newest reading of the state file, else by asking ptp4l and the kernel, for whoever may.
std::optional<PtpReading> read_ptp();

}  // namespace vantage
