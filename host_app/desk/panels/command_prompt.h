#pragma once

#include <string>

#include "host_app/control/table/control_command.h"

namespace vantage {

/// A line in which any command of the table is typed with its argument, or a time alone.
class CommandPrompt {
  public:
    bool is_open() const { return is_open_; }
    void open() { is_open_ = true; }
    void close() { *this = CommandPrompt(); }
    /// A letter, as a keyboard gives it. What no command has is left out.
    void type(unsigned codepoint);
    void erase();
    /// As much of a command's name as all have that begin so.
    void complete();
    /// What was typed; it stays open. Nothing: there is none, and line() says why.
    std::optional<CommandCall> call();
    /// For the desk.
    std::string line() const;

  private:
    bool is_open_ = false;
    std::string typed_, fault_;
};

}  // namespace vantage
