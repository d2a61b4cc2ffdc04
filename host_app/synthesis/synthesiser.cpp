#include "host_app/synthesis/synthesiser.h"

#include "common/base/error.h"

namespace vantage {

std::span<const RenderLevel> render_levels() {
    static constexpr RenderLevel levels[] = {
        {0, most_drawn_rigs, 2, 1, false, 2},
        {1, 2, 1, 1, false, 2},
        {2, 2, 0, 0.75, false, 1},
        {3, 2, 0, 1, true, 1},
        {4, 2, 0, 0.75, true, 1},
        {5, 2, 0, 0.625, true, 1},
    };
    return levels;
}

SynthesiserEntry find_synthesiser(const std::string& name) {
    std::string known;
    for (const SynthesiserEntry& entry : synthesiser_entries()) {
        if (entry.name == name) return entry;
        known += (known.empty() ? "" : ", ") + entry.name;
    }
    fail("there is no synthesiser named '{}'; the ones there are: {}", name, known);
}

const Texture& Synthesiser::render(const VirtualView& view) {
    instant_ = preparer_->prepare(view, prepare_levels().front());
    return renderer_->render(*instant_, view, render_levels().front());
}

std::unique_ptr<Synthesiser> make_synthesiser(const std::string& name,
                                              const ShaderLibrary& library) {
    return std::make_unique<Synthesiser>(find_synthesiser(name), library);
}

}  // namespace vantage
