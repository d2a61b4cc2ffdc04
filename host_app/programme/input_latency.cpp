#include "host_app/programme/input_latency.h"

#include <algorithm>

namespace vantage {
namespace {

/// The earliest count; pictures stay away for a while only.
constexpr std::size_t most_waiting = 100;

}  // namespace

void InputLatency::saw(MonotonicTime input, std::uint64_t look, bool only_flies) {
    if (waiting_.size() < most_waiting) waiting_.push_back({input, look, only_flies});
}

void InputLatency::showed(std::uint64_t camera_look, std::uint64_t rendered_look, MonotonicTime now) {
    const auto is_shown = [&](const Input& input) {
        return input.look <= (input.only_flies ? camera_look : rendered_look);
    };
    const auto first = std::find_if(waiting_.begin(), waiting_.end(), is_shown);
    if (first == waiting_.end()) return;
    all_ms_.add(to_ms(now - first->time));
    std::erase_if(waiting_, is_shown);
}

bool InputLatency::is_waiting_for_rendering() const {
    return std::any_of(waiting_.begin(), waiting_.end(),
                       [](const Input& input) { return !input.only_flies; });
}

}  // namespace vantage
