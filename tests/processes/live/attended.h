#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "common/base/files/unique_fd.h"
#include "tests/support/child_program.h"

namespace vantage {

/// Returns the event of this name from lines of JSON; null if there is none.
nlohmann::json event_of(const std::string& out, const std::string& name, std::size_t skip = 0);

/// A program with an operator at its standard input that prints events as lines of JSON.
class Attended {
  public:
    /// `name` is that of its folder and pipe in `folder`.
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

/// Types the code of `vantage-rig pair` at `vantage setup` and the other way round.
void compare_codes(const Attended& host, const Attended& rig, std::size_t codes_before);

}  // namespace vantage
