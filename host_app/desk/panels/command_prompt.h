#pragma once

#include <optional>
#include <string>

#include "host_app/control/table/control_command.h"

namespace vantage {

/// The command line of the desk: it takes any command of the table with its argument, or a time.
class CommandPrompt {
  public:
    bool is_open() const { return is_open_; }
    void open() { is_open_ = true; }
    void close() { *this = CommandPrompt(); }
    /// Adds a character. Characters outside printable ASCII are ignored.
    void type(unsigned codepoint);
    void erase();
    /// Completes the longest prefix that all commands beginning with the typed text share.
    void complete();
    /// Parses the typed text; the prompt stays open. If it does not parse, returns nothing, and
    /// line() shows the reason.
    std::optional<CommandCall> call();
    /// The line as the desk shows it, with the reason of a refused command.
    std::string line() const;

  private:
    bool is_open_ = false;
    std::string typed_, fault_;
};

}  // namespace vantage
