#include "common/base/this_thread.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

namespace vantage {

void name_this_thread(const char* name) { ::pthread_setname_np(::pthread_self(), name); }

std::string this_thread_name() {
    char name[16] = "";
    ::pthread_getname_np(::pthread_self(), name, sizeof name);
    return name;
}

void make_this_thread_nice(int niceness) {
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), niceness);
}

void make_this_thread_idle() {
    const sched_param none{};
    ::sched_setscheduler(0, SCHED_IDLE, &none);
}

}  // namespace vantage
