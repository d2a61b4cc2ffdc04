#include "tests/support/child_program.h"

#include <atomic>
#include <csignal>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "common/base/error.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

std::filesystem::path new_file(const std::filesystem::path& folder, const char* name) {
    static std::atomic<int> count = 0;
    return folder / fmt::format("{}-{}", name, ++count);
}

}  // namespace

ChildProgram::ChildProgram(const std::filesystem::path& program,
                           const std::vector<std::string>& arguments,
                           const std::filesystem::path& folder,
                           const std::vector<std::string>& environment)
    : out_(new_file(folder, "out")),
      err_(new_file(folder, "err")),
      process_({.program = program,
                .arguments = arguments,
                .out = out_,
                .err = err_,
                .environment = environment}) {}

ChildProgram::~ChildProgram() { send_signal(SIGKILL); }

std::string ChildProgram::out() const { return text_of(out_); }
std::string ChildProgram::err() const { return text_of(err_); }

void ChildProgram::wait_for(const std::string& words) {
    const auto has_said = [&] { return err().find(words) != std::string::npos; };
    std::optional<int> status;
    (void)eventually([&] { return has_said() || (status = ended()); });
    if (has_said()) return;
    fail("'{}' is not in the log of a program{}:\n{}", words,
         status ? fmt::format(" that ended with status {}", *status) : "", err());
}

ProgramResult ChildProgram::wait() { return {process_.wait(), out(), err()}; }

ProgramResult run_to_end(const std::filesystem::path& program,
                         const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment) {
    const TemporaryFolder folder;
    return ChildProgram(program, arguments, folder.path(), environment).wait();
}

}  // namespace vantage
