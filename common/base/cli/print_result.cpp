#include "common/base/cli/print_result.h"

#include <iostream>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vantage {

void print_result(const nlohmann::ordered_json& result, bool as_json) {
    if (as_json) {
        std::cout << result.dump() << '\n';
        return;
    }
    for (const auto& [key, value] : result.items()) {
        if (value.is_structured()) continue;
        std::cout << fmt::format("{:16} {}\n", key,
                                 value.is_string() ? value.get<std::string>() : value.dump());
    }
}

void EventTeller::tell(const nlohmann::ordered_json& facts, const std::string& words) const {
    std::cout << (as_json_ ? facts.dump() + "\n" : words) << std::flush;
}

}  // namespace vantage
