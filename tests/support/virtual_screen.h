#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {

/// An X screen of a test's own (Xvfb), with hands that move its mouse and press its keys (xdotool):
/// what a program sees are real X events.
class VirtualScreen {
  public:
    /// Throws Error if Xvfb does not come up.
    VirtualScreen(int width_px, int height_px);

    /// Whether this computer has what it takes.
    static bool is_there();

    /// "DISPLAY=:7", for a program that is to show itself here.
    std::string environment() const { return "DISPLAY=" + display_; }
    const std::string& display() const { return display_; }

    /// xdotool's commands, one after the other. Throws Error, with what it says, if one fails.
    void operator_input(const std::vector<std::string>& commands) const;

  private:
    TemporaryFolder folder_;
    std::unique_ptr<ChildProgram> server_;
    std::string display_;
};

}  // namespace vantage
