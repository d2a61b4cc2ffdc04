#include "host_app/control/table/lamp.h"

#include "host_app/control/table/lamp_parts.h"

namespace vantage {

std::span<const Lamp> lamps() {
    static const std::vector<Lamp> both = [] {
        std::vector<Lamp> all;
        for (const auto part : {replay_lamps(), show_lamps()})
            all.insert(all.end(), part.begin(), part.end());
        return all;
    }();
    return both;
}

const char* kind_words(const Lamp& lamp) {
    const LampValue value = lamp.of({});
    if (std::holds_alternative<bool>(value)) return "switch";
    return std::holds_alternative<double>(value) ? "number" : "word";
}

}  // namespace vantage
