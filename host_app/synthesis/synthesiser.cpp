#include "host_app/synthesis/synthesiser.h"

#include "common/base/error.h"

namespace vantage {

std::unique_ptr<Synthesiser> make_synthesiser(const std::string& name,
                                              const ShaderLibrary& library) {
    std::string known;
    for (const SynthesiserEntry& entry : synthesiser_entries()) {
        if (entry.name == name) return entry.make(library);
        known += (known.empty() ? "" : ", ") + entry.name;
    }
    fail("there is no synthesiser named '{}'; the ones there are: {}", name, known);
}

}  // namespace vantage
