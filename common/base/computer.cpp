#include "common/base/computer.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/sysinfo.h>
#include <sys/utsname.h>

#include "common/base/error.h"

namespace vantage {
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

void require_descriptors(std::size_t needed, const std::string& what) {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    if (limit.rlim_cur < limit.rlim_max) {
        limit.rlim_cur = limit.rlim_max;
        setrlimit(RLIMIT_NOFILE, &limit);
        getrlimit(RLIMIT_NOFILE, &limit);
    }
    std::error_code ignored;
    std::size_t open = 0;
    for (auto file = std::filesystem::directory_iterator("/proc/self/fd", ignored);
         file != std::filesystem::directory_iterator(); file.increment(ignored))
        ++open;
    if (limit.rlim_cur >= open + needed) return;
    fail(
        "{} needs {} more open files, and this process may have {}, of which {} are open: raise "
        "the "
        "limit (ulimit -n {}, or LimitNOFILE= in a systemd unit)",
        what, needed, limit.rlim_cur, open, std::max<std::size_t>(1024, open + needed));
}

}  // namespace vantage
