#include "common/base/files/data_sync.h"

#include <cerrno>

#include <unistd.h>

namespace vantage {

int sync_data(int fd) {
    if (::fdatasync(fd) == 0 || errno == EINVAL || errno == ENOSYS) return 0;
    return errno;
}

}  // namespace vantage
