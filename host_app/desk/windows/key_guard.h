#pragma once

#include <string>

namespace vantage {

/// What ends or destroys something is asked for twice: a key is obeyed only when it is pressed
/// again while its question stands.
class KeyGuard {
  public:
    static constexpr double asks_for_s = 3;

    /// Whether this question stands already; else it does from now on.
    bool confirms(const std::string& question, double now_s) {
        const bool is_again = question == question_ && now_s < until_s_;
        question_ = is_again ? std::string() : question;
        until_s_ = now_s + asks_for_s;
        return is_again;
    }
    /// Empty: nothing is asked.
    std::string question(double now_s) const {
        return now_s < until_s_ ? question_ : std::string();
    }

  private:
    std::string question_;
    double until_s_ = 0;
};

}  // namespace vantage
