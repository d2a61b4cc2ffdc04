#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/base/child_process.h"

namespace vantage {

struct ProgramResult {
    int status = -1;  ///< exit status; 128 + n if signal n ended it
    std::string out, err;
};

/// Runs a program as a user does: as a child process, with its output in files of a folder that
/// outlives it.
class ChildProgram {
  public:
    /// `environment`: "NAME=VALUE", added to this process's. Throws Error if the program cannot be
    /// started.
    ChildProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 const std::filesystem::path& folder,
                 const std::vector<std::string>& environment = {});
    /// Kills the process if it is still running.
    ~ChildProgram();

    void send_signal(int signal) const { process_.send_signal(signal); }
    /// The output so far.
    std::string out() const;
    std::string err() const;
    /// Waits until it has logged these words. Throws Error, with its log, if it does not or ends.
    void wait_for(const std::string& words);
    /// Waits for the end.
    ProgramResult wait();
    /// The status as from wait(), if the process has ended.
    std::optional<int> ended() { return process_.ended(); }

  private:
    std::filesystem::path out_, err_;
    ChildProcess process_;
};

ProgramResult run_to_end(const std::filesystem::path& program,
                         const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment = {});

}  // namespace vantage
