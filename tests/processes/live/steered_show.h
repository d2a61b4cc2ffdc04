#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "host_app/replay/clip.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {

/// A show that oscsend steers and whose lamps oscdump prints; each is a process.
class SteeredShow {
  public:
    /// `arguments` are those of vantage without --control.
    SteeredShow(std::vector<std::string> arguments, const TemporaryFolder& folder);

    /// Sends an OSC address with its types and arguments; false on failure.
    bool send(const std::string& words) const;
    /// Waits until oscdump has printed these words; false after a minute.
    bool is_told(const std::string& words) const;
    /// Returns the last value of a lamp as oscdump prints it: "1", "2.5", "live"; empty: none.
    std::string lamp(const std::string& name) const;
    /// Waits until a lamp has this value; the failure names its last value.
    testing::AssertionResult shows(const std::string& name, const std::string& value) const;
    /// Waits until a numeric lamp is above this value; false after a minute.
    bool goes_past(const std::string& name, double value) const;
    std::string told() const { return watcher_.out(); }
    ChildProgram& show() { return show_; }

  private:
    SteeredShow(std::vector<std::string> arguments, const TemporaryFolder& folder,
                std::pair<int, int> ports);

    int port_;
    ChildProgram watcher_, show_;
};

/// Waits until a show has saved the clip with this number; the failure names the file.
Clip saved_clip(const std::filesystem::path& file, int number, double pulse_rate_hz);

}  // namespace vantage
