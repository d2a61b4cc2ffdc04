#pragma once

#include <string_view>

namespace vantage {

/// A file as it was built in.
struct EmbeddedText {
    std::string_view name, text;
};

}  // namespace vantage
