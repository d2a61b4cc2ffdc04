#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace vantage {

/// A child process in a process group of its own, so that Ctrl-C at the terminal does not reach it.
/// It is killed when the thread that started it ends, for whatever reason.
class ChildProcess {
  public:
    struct Settings {
        std::filesystem::path program;
        std::vector<std::string> arguments{};
        std::filesystem::path out{}, err{};        ///< files for its output; empty: /dev/null
        std::vector<std::string> environment{};    ///< "NAME=VALUE", added to this environment
        int niceness = 0;                          ///< added to this process's niceness
        std::chrono::milliseconds patience{5000};  ///< from SIGTERM to SIGKILL
    };
    /// Starts the program. Throws Error if it cannot be started.
    explicit ChildProcess(const Settings& settings);
    /// Sends SIGTERM, and SIGKILL if the process does not end within `patience`.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    void send_signal(int signal) const;
    /// Waits for the end and returns the exit status; 128 + n where signal n ended the process.
    int wait();
    /// The exit status as from wait(), if the process has ended. Never waits.
    std::optional<int> ended();

  private:
    std::optional<int> status_after(int options);

    pid_t pid_ = -1;
    std::chrono::milliseconds patience_;
    std::optional<int> status_;
};

/// The folder that holds the executable of this process.
std::filesystem::path program_folder();

}  // namespace vantage
