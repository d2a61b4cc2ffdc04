#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "common/base/files/unique_fd.h"
#include "tests/support/child_program.h"

namespace vantage {

/// The event of that name among lines of JSON; null if it has not come.
nlohmann::json event_of(const std::string& out, const std::string& name, std::size_t skip = 0);

/// A program with a person at its standard input, which tells what happens as lines of JSON.
class Attended {
  public:
    /// `name`: of its folder and pipe in `folder`.
    Attended(const std::string& program, const std::string& arguments,
             const std::filesystem::path& folder, const std::string& name);

    nlohmann::json wait_for(const std::string& event, std::size_t skip = 0) const;
    void type(const std::string& line) const;
    ProgramResult end() { return child_->wait(); }

  private:
    std::filesystem::path pipe_;
    UniqueFd fd_;
    std::unique_ptr<ChildProgram> child_;
};

/// Of `vantage setup` and `vantage-rig pair` each is typed what the other shows.
void compare_codes(const Attended& host, const Attended& rig, std::size_t codes_before);

}  // namespace vantage
