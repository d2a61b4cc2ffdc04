#pragma once

namespace vantage {

/// Names the calling thread as `top -H` and debuggers show it, 15 letters at most. Threads that it
/// begins take the name over until they have their own.
void name_this_thread(const char* name);

/// From now on the calling thread, and threads that it begins, leave the processor to those of less
/// niceness where there is too little of it, from 0, as others, to 19. Cannot be taken back.
void make_this_thread_nice(int niceness);

/// From now on the calling thread, and threads that it begins, have a processor only while nobody
/// else wants it: to who wakes up it counts as idle (SCHED_IDLE). Cannot be taken back.
void make_this_thread_idle();

}  // namespace vantage
