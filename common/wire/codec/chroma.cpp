#include "common/wire/codec/chroma.h"

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr Chroma all_chromas[] = {Chroma::full, Chroma::half, Chroma::quarter};

}  // namespace

std::string_view name_of(Chroma chroma) {
    switch (chroma) {
        case Chroma::full:
            return "4:4:4";
        case Chroma::half:
            return "4:2:2";
        case Chroma::quarter:
            break;
    }
    return "4:2:0";
}

Chroma parse_chroma(std::string_view name) {
    for (const Chroma chroma : all_chromas)
        if (name == name_of(chroma)) return chroma;
    fail("chroma '{}' is not one of 4:4:4, 4:2:2 and 4:2:0", name);
}

}  // namespace vantage
