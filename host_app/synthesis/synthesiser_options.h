#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// An option of a synthesiser: one of several words, or a number.
struct SynthesiserOption {
    std::string name;  ///< with its unit: "focal-m"
    std::string summary;
    std::string by_default;
    std::vector<std::string> words;  ///< the allowed words; empty: a number within the limits
    double least = 0, most = 0;
};

/// The values of all options of a synthesiser, chosen or default.
class SynthesiserChoices {
  public:
    /// Parses "NAME=VALUE,NAME=VALUE..." or an empty text. Throws Error, which names the option and
    /// the allowed values, if something does not fit.
    SynthesiserChoices(std::string_view synthesiser, std::string_view text,
                       std::span<const SynthesiserOption> options);

    /// Precondition: one of the synthesiser's options.
    const std::string& word(const std::string& name) const { return values_.at(name); }
    double number(const std::string& name) const;

  private:
    std::map<std::string, std::string> values_;
};

}  // namespace vantage
