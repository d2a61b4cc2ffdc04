#include "common/base/event_teller.h"

#include <iostream>

#include <nlohmann/json.hpp>

namespace vantage {

void EventTeller::tell(const nlohmann::ordered_json& facts, const std::string& words) const {
    std::cout << (as_json_ ? facts.dump() + "\n" : words) << std::flush;
}

}  // namespace vantage
