#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Which key of this keyboard is meant by a letter or sign: the one whose cap has it. GLFW numbers
/// keys by their place on a US keyboard, so that on a French keyboard its key M is labelled "," and
/// its key ";" is labelled M.
///
/// Digits go by their place, as keyboards that need Shift for them have them there too. A sign that
/// no cap has goes by its place, unless the cap there has a letter or another command's sign; and
/// so do the letters of a keyboard without Latin letters.
class KeyCaps {
  public:
    /// `label_of`: what is on the cap of one of GLFW's keys, without Shift; empty: nothing.
    /// `signs`: the signs, other than letters and digits, that commands use.
    explicit KeyCaps(std::function<std::string(int key)> label_of, std::string signs);

    /// GLFW's key of a US keyboard that is meant by this key; the key itself where it has no cap of
    /// that kind. -1: it means nothing.
    int meant_by(int key) const;
    /// The key that has this letter or sign (as GLFW numbers it); -1: none has.
    int place_of(int meant) const;
    /// For people: the signs and letters that lie elsewhere than on a US keyboard, such as "M is at
    /// ;". Empty: none does.
    std::string words() const;

  private:
    /// The letter or sign of one character on the cap, upper case; 0: there is none.
    int cap_of(int key) const;

    std::function<std::string(int)> label_of_;
    std::string signs_;
};

}  // namespace vantage
