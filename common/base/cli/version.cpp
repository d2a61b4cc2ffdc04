#include "common/base/cli/version.h"

#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <sys/sysinfo.h>
#include <sys/utsname.h>

namespace vantage {

std::string_view version() { return VANTAGE_VERSION; }

namespace {

std::string system_name() {
    std::ifstream file("/etc/os-release");
    const std::string key = "PRETTY_NAME=\"";
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(key) && line.ends_with('"'))
            return line.substr(key.size(), line.size() - key.size() - 1);
    return "an unknown system";
}

}  // namespace

std::string computer_words() {
    utsname kernel{};
    ::uname(&kernel);
    struct sysinfo memory {};
    ::sysinfo(&memory);
    constexpr double bytes_a_gb = 1e9;
    return fmt::format(
        "{}, {} {} on {}, {} processors, {:.1f} GB", system_name(), kernel.sysname, kernel.release,
        kernel.machine, std::thread::hardware_concurrency(),
        static_cast<double>(memory.totalram) * static_cast<double>(memory.mem_unit) / bytes_a_gb);
}

}  // namespace vantage
