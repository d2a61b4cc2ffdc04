#pragma once

#include <string>

namespace vantage {

/// From now on, in the whole process, what FFmpeg complains about is kept for take_av_remark() and
/// goes to the log at its level `debug` only: its return values are often less than half the story.
/// What libsrt writes becomes one line of our log in ten seconds, with how many messages it was.
void keep_av_log();

/// What FFmpeg complained about last on this thread since the last call; empty: nothing.
std::string take_av_remark();

}  // namespace vantage
