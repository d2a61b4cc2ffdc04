#include "tests/support/child_program.h"

#include <atomic>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include "common/base/error.h"
#include "tests/support/data_folder.h"

extern char** environ;

namespace vantage {
namespace {

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// As exec wants them: ended by a null pointer.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

}  // namespace

ChildProgram::ChildProgram(const std::filesystem::path& program,
                           const std::vector<std::string>& arguments,
                           const std::filesystem::path& folder,
                           const std::vector<std::string>& environment) {
    static std::atomic<int> count = 0;
    const int number = ++count;
    out_ = folder / fmt::format("out-{}", number);
    err_ = folder / fmt::format("err-{}", number);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), flags, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), flags, 0600);
    std::vector<std::string> words = {program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    // The first of two variables of one name counts.
    std::vector<std::string> variables = environment;
    for (char** variable = environ; *variable; ++variable) variables.emplace_back(*variable);
    std::vector<char*> argv = pointers_to(words), envp = pointers_to(variables);
    const int code =
        posix_spawn(&pid_, program.c_str(), &actions, nullptr, argv.data(), envp.data());
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) fail("cannot start {}: {}", program.string(), std::strerror(code));
}

ChildProgram::~ChildProgram() {
    if (pid_ < 0) return;
    send_signal(SIGKILL);
    ::waitpid(pid_, nullptr, 0);
}

void ChildProgram::send_signal(int signal) const {
    if (pid_ >= 0) ::kill(pid_, signal);
}

std::string ChildProgram::out() const { return text_of(out_); }
std::string ChildProgram::err() const { return text_of(err_); }

ProgramResult ChildProgram::wait() {
    int state = 0;
    while (::waitpid(pid_, &state, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    const int status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    return {status, out(), err()};
}

ProgramResult run_to_end(const std::filesystem::path& program,
                         const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment) {
    const TemporaryFolder folder;
    return ChildProgram(program, arguments, folder.path(), environment).wait();
}

}  // namespace vantage
