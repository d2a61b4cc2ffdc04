#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {

/// A show steered by oscsend, whose lamps oscdump watches: each a process of its own.
class SteeredShow {
  public:
    /// `arguments`: of vantage, without --control.
    SteeredShow(std::vector<std::string> arguments, const TemporaryFolder& folder);

    /// Sends an OSC address with its types and arguments; false if that could not be done.
    bool send(const std::string& words) const;
    /// Waits until oscdump has printed these words; false if that does not come.
    bool is_told(const std::string& words) const;
    /// What a lamp was told to be last, as oscdump writes it: "1", "2.5", "live"; empty: nothing.
    std::string lamp(const std::string& name) const;
    /// Waits until a lamp is this; a failure that says what it is if that does not come.
    testing::AssertionResult shows(const std::string& name, const std::string& value) const;
    /// Waits until a lamp that is a number is above this; false if that does not come.
    bool goes_past(const std::string& name, double value) const;
    std::string told() const { return watcher_.out(); }
    ChildProgram& show() { return show_; }

  private:
    SteeredShow(std::vector<std::string> arguments, const TemporaryFolder& folder,
                std::pair<int, int> ports);

    int port_;
    ChildProgram watcher_, show_;
};

}  // namespace vantage
