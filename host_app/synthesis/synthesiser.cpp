#include "host_app/synthesis/synthesiser.h"

#include <fmt/format.h>

#include "common/base/error.h"

namespace vantage {
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
