#include "common/base/files/descriptor_limit.h"

#include <algorithm>
#include <filesystem>

#include <sys/resource.h>

#include "common/base/error.h"

namespace vantage {

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
    constexpr std::size_t usual_limit = 1024;
    fail(
        "{} needs {} more open files, and this process may have {}, of which {} are open: raise "
        "the limit (ulimit -n {}, or LimitNOFILE= in a systemd unit)",
        what, needed, limit.rlim_cur, open, std::max(usual_limit, open + needed));
}

}  // namespace vantage
