#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {

/// An X display of a test's own (Xvfb), with simulated mouse and keyboard input (xdotool) that
/// arrives as real X events.
class VirtualScreen {
  public:
    /// Throws Error if Xvfb does not start.
    VirtualScreen(int width_px, int height_px);

    /// Whether this computer has the required programs.
    static bool is_there();

    /// "DISPLAY=:7", for the environment of a program.
    std::string environment() const { return "DISPLAY=" + display_; }
    const std::string& display() const { return display_; }

    /// Runs xdotool commands in sequence. Throws Error with its output if one fails.
    void operator_input(const std::vector<std::string>& commands) const;

  private:
    TemporaryFolder folder_;
    std::unique_ptr<ChildProgram> server_;
    std::string display_;
};

}  // namespace vantage
