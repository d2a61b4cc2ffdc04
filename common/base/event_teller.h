#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace vantage {

/// What happens while a command runs, on stdout: words for a person at a terminal or, a line of
/// JSON each, facts for a program. At once, since somebody waits for it.
class EventTeller {
  public:
    explicit EventTeller(bool as_json) : as_json_(as_json) {}
    /// `words` end their lines themselves: a question leaves its own open.
    void tell(const nlohmann::ordered_json& facts, const std::string& words) const;

  private:
    bool as_json_;
};

}  // namespace vantage
