#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace vantage {

/// Prints a command's result to stdout: one JSON object on one line with `as_json`, otherwise one
/// line per key, without nested values.
void print_result(const nlohmann::ordered_json& result, bool as_json);

/// Prints the progress of a command to stdout as it happens: text for people or, with --json, one
/// JSON object per line. Flushes after each event.
class EventTeller {
  public:
    explicit EventTeller(bool as_json) : as_json_(as_json) {}
    /// `words` includes its own line end, so that a question can leave its line open.
    void tell(const nlohmann::ordered_json& facts, const std::string& words) const;

  private:
    bool as_json_;
};

}  // namespace vantage
