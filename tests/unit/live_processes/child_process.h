#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace vantage {

/// A program that a test runs; ended at destruction if it still runs. Its output goes to files.
class ChildProcess {
  public:
    /// `name` names the files NAME.out and NAME.err in the folder.
    ChildProcess(const std::filesystem::path& folder, const std::string& name,
                 const std::vector<std::string>& command);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    void send(int signal) const;
    /// Waits for its end. The exit status, or 128 + the signal that ended it.
    int wait();

    std::string standard_output() const;
    std::string standard_error() const;

  private:
    std::filesystem::path out_, err_;
    pid_t pid_ = -1;
};

}  // namespace vantage
