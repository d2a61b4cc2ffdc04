#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

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
    /// Ends it if it still runs.
    ~ChildProgram();
    ChildProgram(const ChildProgram&) = delete;
    ChildProgram& operator=(const ChildProgram&) = delete;

    void send_signal(int signal) const;
    /// What it wrote so far.
    std::string out() const;
    std::string err() const;
    /// Waits for its end.
    ProgramResult wait();

  private:
    pid_t pid_ = -1;
    std::filesystem::path out_, err_;
};

ProgramResult run_to_end(const std::filesystem::path& program,
                         const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment = {});

}  // namespace vantage
