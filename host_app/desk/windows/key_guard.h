#pragma once

#include <string>

namespace vantage {

/// Confirmation of keys that end or delete something: such a key acts only when it is pressed a
/// second time while its question is shown. Times are GLFW's seconds.
class KeyGuard {
  public:
    static constexpr double asks_for_s = 3;  ///< how long a question is shown

    /// Returns whether this question is already shown; otherwise shows it.
    bool confirms(const std::string& question, double now_s) {
        const bool is_again = question == question_ && now_s < until_s_;
        question_ = is_again ? std::string() : question;
        until_s_ = now_s + asks_for_s;
        return is_again;
    }
    /// The question that is shown now; empty: none.
    std::string question(double now_s) const {
        return now_s < until_s_ ? question_ : std::string();
    }

  private:
    std::string question_;
    double until_s_ = 0;
};

}  // namespace vantage
