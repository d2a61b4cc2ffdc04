#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Maps keys to the letters and signs that are printed on their caps. GLFW numbers keys by their
/// place on a US keyboard, so that on a French keyboard its key M is labelled "," and its key ";"
/// is labelled M.
///
/// Digits go by their place, since keyboards that need Shift for digits have them in the same
/// place. A sign that no cap has goes by its place, unless the cap there has a letter or the sign
/// of another command. The letters of a keyboard without Latin letters go by their place.
class KeyCaps {
  public:
    /// `label_of` returns what is printed on the cap of a GLFW key, without Shift; empty if
    /// nothing. `signs` are the characters other than letters and digits that commands use.
    explicit KeyCaps(std::function<std::string(int key)> label_of, std::string signs);

    /// Returns the GLFW key of a US keyboard that has the same cap; `key` itself if its cap has no
    /// letter or sign of a command; -1 if the key has no meaning.
    int meant_by(int key) const;
    /// Returns the GLFW key whose cap has this letter or sign; -1 if there is none.
    int place_of(int meant) const;
    /// Lists the letters and signs that lie elsewhere than on a US keyboard, such as "M is where a
    /// US keyboard has ;". Empty if there are none.
    std::string words() const;

  private:
    /// Returns the letter (upper case) or sign on the cap; 0 if there is none or it is not ASCII.
    int cap_of(int key) const;

    std::function<std::string(int)> label_of_;
    std::string signs_;
};

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
