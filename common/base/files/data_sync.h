#pragma once

namespace vantage {

/// Waits until what was written to a file is on its disk. The system's reason why it is not
/// (errno); 0: it is, or the file system cannot tell. A reason is told once: whoever throws it away
/// has lost what was written without a word, for write() may go on well long after a disk is gone.
int sync_data(int fd);

}  // namespace vantage
