#include "host_app/output/media/disk_sync.h"

#include <chrono>
#include <condition_variable>
#include <mutex>

#include <fcntl.h>

#include "common/base/files/atomic_file.h"

namespace vantage {

DiskSync::DiskSync(const std::filesystem::path& path)
    : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)), thread_([this](const std::stop_token& stop) {
          constexpr std::chrono::seconds period{1};
          std::mutex mutex;
          std::condition_variable_any woken;
          std::unique_lock lock(mutex);
          while (!woken.wait_for(lock, stop, period, [&] { return stop.stop_requested(); })) now();
      }) {}

void DiskSync::now() {
    if (const int reason = sync_data(fd_.get()); reason != 0) failure_ = reason;
}

}  // namespace vantage
