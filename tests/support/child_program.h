#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/base/child_process.h"

namespace vantage {

struct ProgramResult {
    int status = -1;  ///< exit status; 128 + n where signal n ended it
    std::string out, err;
};

/// A program of ours run as a user runs it: another process, its output in files of a folder that
/// outlives it.
class ChildProgram {
  public:
    /// `environment`: "NAME=VALUE" on top of this process's own. Throws Error if it cannot be
    /// started.
    ChildProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 const std::filesystem::path& folder,
                 const std::vector<std::string>& environment = {});
    /// Kills it if it still runs.
    ~ChildProgram();

    void send_signal(int signal) const { process_.send_signal(signal); }
    /// What it wrote so far.
    std::string out() const;
    std::string err() const;
    /// Waits for its end.
    ProgramResult wait();
    /// As wait()'s status, if it has ended.
    std::optional<int> ended() { return process_.ended(); }

  private:
    std::filesystem::path out_, err_;
    ChildProcess process_;
};

ProgramResult run_to_end(const std::filesystem::path& program,
                         const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment = {});

}  // namespace vantage
