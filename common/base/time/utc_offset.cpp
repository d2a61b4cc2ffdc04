#include "common/base/time/utc_offset.h"

#include <algorithm>

namespace vantage {

std::optional<int> take_utc_offset(std::string& text) {
    if (text.ends_with('Z') || text.ends_with('z')) {
        text.pop_back();
        return 0;
    }
    // A date contains '-' too. The offset follows the time, which has colons.
    const std::size_t sign = text.find_last_of("+-");
    if (sign == std::string::npos || text.find(':') >= sign) return std::nullopt;
    std::string digits = text.substr(sign + 1);
    if (digits.size() == 5 && digits[2] == ':') digits.erase(2, 1);
    const bool fits =
        (digits.size() == 2 || digits.size() == 4) &&
        std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!fits) return std::nullopt;
    const int hours = std::stoi(digits.substr(0, 2));
    const int minutes = digits.size() == 4 ? std::stoi(digits.substr(2)) : 0;
    constexpr int most_hours = 14, s_per_minute = 60;
    if (hours > most_hours || minutes >= 60) return std::nullopt;
    const int offset_s = s_per_minute * (60 * hours + minutes);
    const bool is_behind = text[sign] == '-';
    text.resize(sign);
    return is_behind ? -offset_s : offset_s;
}

}  // namespace vantage
