#include "common/base/child_process.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"

namespace vantage {
namespace {

/// The argument list in the form that exec() takes: ended by a null pointer.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

UniqueFd open_to_write(const std::filesystem::path& file) {
    const char* name = file.empty() ? "/dev/null" : file.c_str();
    UniqueFd fd(::open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
    if (!fd) fail("cannot write {}: {}", name, std::strerror(errno));
    return fd;
}

}  // namespace

ChildProcess::ChildProcess(const Settings& settings) : patience_(settings.patience) {
    std::vector<std::string> words = {settings.program.string()};
    words.insert(words.end(), settings.arguments.begin(), settings.arguments.end());
    // Where a variable occurs twice, the first one counts.
    std::vector<std::string> variables = settings.environment;
    for (char** variable = environ; *variable; ++variable) variables.emplace_back(*variable);
    std::vector<char*> argv = pointers_to(words), envp = pointers_to(variables);
    const UniqueFd in(::open("/dev/null", O_RDONLY | O_CLOEXEC)), out = open_to_write(settings.out),
                                                                  err = open_to_write(settings.err);
    // Carries errno from a failed exec() to the parent. A successful exec() closes it.
    int report[2];
    if (::pipe2(report, O_CLOEXEC) != 0) fail("cannot start a program: {}", std::strerror(errno));
    const UniqueFd reads(report[0]);
    UniqueFd writes(report[1]);
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0) {
        // Between fork() and exec() nothing may take a lock that another thread may have held.
        ::setpgid(0, 0);
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent) ::_exit(1);
        sigset_t none;
        sigemptyset(&none);
        ::sigprocmask(SIG_SETMASK, &none, nullptr);
        errno = 0;
        (void)::nice(settings.niceness);
        ::dup2(in.get(), STDIN_FILENO);
        ::dup2(out.get(), STDOUT_FILENO);
        ::dup2(err.get(), STDERR_FILENO);
        ::execve(argv[0], argv.data(), envp.data());
        const int reason = errno;
        (void)!::write(writes.get(), &reason, sizeof reason);
        ::_exit(127);
    }
    if (pid_ < 0) fail("cannot start {}: {}", settings.program.string(), std::strerror(errno));
    writes = UniqueFd();
    int reason = 0;
    if (::read(reads.get(), &reason, sizeof reason) == sizeof reason) {
        (void)wait();
        fail("cannot start {}: {}", settings.program.string(), std::strerror(reason));
    }
}

ChildProcess::~ChildProcess() {
    send_signal(SIGTERM);
    const auto end = std::chrono::steady_clock::now() + patience_;
    while (!ended() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    send_signal(SIGKILL);
    (void)wait();
}

void ChildProcess::send_signal(int signal) const {
    if (!status_) ::kill(pid_, signal);
}

int ChildProcess::wait() { return *status_after(0); }
std::optional<int> ChildProcess::ended() { return status_after(WNOHANG); }

std::optional<int> ChildProcess::status_after(int options) {
    if (status_) return status_;
    int state = 0;
    pid_t found = 0;
    while ((found = ::waitpid(pid_, &state, options)) < 0 && errno == EINTR) {
    }
    if (found == 0) return std::nullopt;
    status_ = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    return status_;
}

std::filesystem::path program_folder() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

}  // namespace vantage
