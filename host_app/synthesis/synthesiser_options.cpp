#include "host_app/synthesis/synthesiser_options.h"

#include <algorithm>
#include <charconv>

#include <fmt/ranges.h>

#include "common/base/error.h"

namespace vantage {
namespace {

double number_in(const std::string& text, bool& is_one) {
    double number = 0;
    const char* last = text.data() + text.size();
    const std::from_chars_result read = std::from_chars(text.data(), last, number);
    is_one = read.ec == std::errc() && read.ptr == last;
    return number;
}

void require_fit(std::string_view synthesiser, const SynthesiserOption& option,
                 const std::string& value) {
    if (!option.words.empty()) {
        if (std::find(option.words.begin(), option.words.end(), value) == option.words.end())
            fail("{} of the synthesiser {} is one of {}, not '{}'", option.name, synthesiser,
                 fmt::join(option.words, ", "), value);
        return;
    }
    bool is_number = false;
    const double number = number_in(value, is_number);
    if (!is_number || !(number >= option.least && number <= option.most))
        fail("{} of the synthesiser {} is a number from {:g} to {:g}, not '{}'", option.name,
             synthesiser, option.least, option.most, value);
}

}  // namespace

SynthesiserChoices::SynthesiserChoices(std::string_view synthesiser, std::string_view text,
                                       std::span<const SynthesiserOption> options) {
    for (const SynthesiserOption& option : options) values_[option.name] = option.by_default;
    while (!text.empty()) {
        const std::string_view one = text.substr(0, text.find(','));
        text.remove_prefix(std::min(one.size() + 1, text.size()));
        const std::string name(one.substr(0, one.find('=')));
        const auto found = std::find_if(options.begin(), options.end(),
                                        [&](const auto& option) { return option.name == name; });
        if (found == options.end()) {
            std::vector<std::string> known;
            for (const SynthesiserOption& option : options) known.push_back(option.name);
            if (known.empty())
                fail("the synthesiser {} has no options: leave out ':{}'", synthesiser, one);
            fail("the synthesiser {} has no option '{}'; it has {}", synthesiser, name,
                 fmt::join(known, ", "));
        }
        const std::string value(one.size() > name.size() ? one.substr(name.size() + 1) : "");
        require_fit(synthesiser, *found, value);
        values_[name] = value;
    }
}

double SynthesiserChoices::number(const std::string& name) const {
    bool is_number = false;
    return number_in(values_.at(name), is_number);
}

}  // namespace vantage
