#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace vantage {

/// Another program, in a process group of its own: what interrupts this program at a terminal
/// leaves it alone. It ends with the thread that started it, whatever ends that.
class ChildProcess {
  public:
    struct Settings {
        std::filesystem::path program;
        std::vector<std::string> arguments{};
        std::filesystem::path out{}, err{};        ///< files that it writes to; empty: nowhere
        std::vector<std::string> environment{};    ///< "NAME=VALUE", over this process's own
        int niceness = 0;                          ///< added to this process's own
        std::chrono::milliseconds patience{5000};  ///< from being asked to end to being killed
    };
    /// Throws Error if it cannot be started.
    explicit ChildProcess(const Settings& settings);
    /// Asks it to end (SIGTERM), and kills it where it does not in time.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    void send_signal(int signal) const;
    /// Waits for its end; 128 + n where signal n ended it.
    int wait();
    /// As wait(), if it has ended.
    std::optional<int> ended();

  private:
    std::optional<int> status_after(int options);

    pid_t pid_ = -1;
    std::chrono::milliseconds patience_;
    std::optional<int> status_;
};

/// The folder of the running program.
std::filesystem::path program_folder();

}  // namespace vantage
