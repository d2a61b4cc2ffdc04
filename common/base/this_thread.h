#pragma once

#include <string>

namespace vantage {

/// Names the calling thread as `top -H` and debuggers show it, with at most 15 characters. Threads
/// that it starts inherit the name until they set their own.
void name_this_thread(const char* name);
std::string this_thread_name();

/// Sets the niceness of the calling thread, and of threads that it starts later, from 0 to 19.
/// Cannot be undone.
void make_this_thread_nice(int niceness);

/// Schedules the calling thread, and threads that it starts later, only on otherwise idle
/// processors (SCHED_IDLE). Unlike a high niceness, it never delays a thread that wakes up. Cannot
/// be undone.
void make_this_thread_idle();

}  // namespace vantage
