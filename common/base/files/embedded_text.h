#pragma once

#include <string_view>

namespace vantage {

/// A text file that the build embeds in the program.
struct EmbeddedText {
    std::string_view name, text;
};

}  // namespace vantage
