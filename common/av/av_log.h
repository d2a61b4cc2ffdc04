#pragma once

#include <string>

namespace vantage {

/// Redirects FFmpeg's log of the whole process: messages are kept for take_av_remark() and logged
/// at level `debug` only. FFmpeg's return values alone often do not explain a fault.
/// Messages of libsrt become at most one counted line of our log in ten seconds.
void keep_av_log();

/// FFmpeg's last message on this thread since the last call; empty if none.
std::string take_av_remark();

}  // namespace vantage
