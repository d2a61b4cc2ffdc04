#include "host_app/synthesis/synthesiser.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
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

namespace {

SynthesiserEntry with_choices(SynthesiserEntry entry, const std::string& asked) {
    const std::size_t colon = asked.find(':');
    const SynthesiserChoices choices(
        entry.name, colon == std::string::npos ? "" : asked.substr(colon + 1), entry.options);
    if (entry.make_renderer_with)
        entry.make_renderer = [make = entry.make_renderer_with, choices](
                                  const ShaderLibrary& library) { return make(library, choices); };
    entry.name = asked;
    return entry;
}

}  // namespace

std::span<const RenderLevel> render_levels() {
    static constexpr RenderLevel levels[] = {
        {0, most_drawn_rigs, 2, 1, false},
        {1, 2, 1, 1, false},
        {2, 2, 0, 0.75, false},
        {3, 2, 0, 1, true},
        {4, 2, 0, 0.75, true},
        {5, 2, 0, 0.625, true},
        {6, 2, 0, 0.5, true},
    };
    return levels;
}

SynthesiserEntry find_synthesiser(const std::string& name) {
    const std::string base = name.substr(0, name.find(':'));
    std::string known[2];
    const std::vector<SynthesiserEntry> lists[2] = {synthesiser_entries(), gallery_entries()};
    for (std::size_t i = 0; i < 2; ++i)
        for (SynthesiserEntry entry : lists[i]) {
            if (entry.name == base) return with_choices(std::move(entry), name);
            known[i] += (known[i].empty() ? "" : ", ") + entry.name;
        }
    fail("there is no synthesiser named '{}'; the ones there are: {}; in the gallery: {}", base,
         known[0], known[1]);
}

std::string synthesisers_type_name() {
    const auto names = [](const std::vector<SynthesiserEntry>& entries) {
        std::string joined;
        for (const SynthesiserEntry& entry : entries)
            joined += (joined.empty() ? "" : ",") + entry.name;
        return joined;
    };
    return fmt::format("{{{}}} or gallery {{{}}}", names(synthesiser_entries()),
                       names(gallery_entries()));
}

std::string synthesisers_help() {
    std::string text = "Synthesisers:";
    const auto add = [&](const std::vector<SynthesiserEntry>& entries) {
        for (const SynthesiserEntry& entry : entries) {
            text += fmt::format("\n  {}: {}", entry.name, entry.summary);
            for (const SynthesiserOption& option : entry.options)
                text +=
                    fmt::format("\n    {}={}: {}", option.name, option.by_default, option.summary);
        }
    };
    add(synthesiser_entries());
    text +=
        "\nGallery of historic synthesisers; options follow the name, as in NAME:OPTION=VALUE,...:";
    add(gallery_entries());
    return text;
}

const Texture& Synthesiser::render(const VirtualView& view) {
    instant_ = preparer_->prepare(view, prepare_levels().front());
    if (const std::string lacking = renderer_->lacks(*instant_, view); !lacking.empty())
        fail("{}", lacking);
    return renderer_->render(*instant_, view, render_levels().front());
}

void Synthesiser::render_earlier(const VirtualView& view) {
    instant_ = preparer_->prepare(view, prepare_levels().front());
    if (renderer_->lacks(*instant_, view).empty())
        renderer_->render(*instant_, view, render_levels().front());
}

std::unique_ptr<Synthesiser> make_synthesiser(const std::string& name,
                                              const ShaderLibrary& library) {
    return std::make_unique<Synthesiser>(find_synthesiser(name), library);
}

}  // namespace vantage
