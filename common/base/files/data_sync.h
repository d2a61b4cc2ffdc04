#pragma once

namespace vantage {

/// Waits until the data written to a file is on disk. Returns 0, also where the file system cannot
/// tell, or errno. The kernel reports a write error only once: a caller that ignores it loses data
/// silently, since write() may keep succeeding after the disk is gone.
int sync_data(int fd);

}  // namespace vantage
