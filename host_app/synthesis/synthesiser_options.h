#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Something that can be chosen of a synthesiser: a word out of some, or a number.
struct SynthesiserOption {
    std::string name;  ///< with its unit: "focal-m"
    std::string summary;
    std::string by_default;
    std::vector<std::string> words;  ///< empty: a number within the limits
    double least = 0, most = 0;
};

/// What was chosen, or is so by default, of every option that a synthesiser has.
class SynthesiserChoices {
  public:
    /// `text` is "NAME=VALUE,NAME=VALUE..." or empty. Throws Error that names the option, what it
    /// takes and which ones `synthesiser` has.
    SynthesiserChoices(std::string_view synthesiser, std::string_view text,
                       std::span<const SynthesiserOption> options);

    /// Precondition: one of the synthesiser's options.
    const std::string& word(const std::string& name) const { return values_.at(name); }
    double number(const std::string& name) const;

  private:
    std::map<std::string, std::string> values_;
};

}  // namespace vantage
