#include "host_app/session/output_switch.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds asks_for{3};
/// Of output 1.
constexpr int first_key = 5;

}  // namespace

void OutputSwitch::press(int number, MonotonicTime now) {
    const auto at = static_cast<std::size_t>(number - 1);
    const std::vector<OutputState> states = desk_.states();
    if (number < 1 || at >= states.size()) {
        asked_ = {number, fmt::format("there is no output {}: --output adds one", number),
                  now + asks_for};
        return;
    }
    const bool runs = desk_.is_wanted(at);
    const bool is_second = asked_ && asked_->number == number && now < asked_->until;
    asked_.reset();
    if (!runs)
        desk_.start(at);
    else if (is_second)
        desk_.stop(at);
    else
        asked_ = {number,
                  fmt::format("F{} again to end {}", first_key + number - 1, states[at].name),
                  now + asks_for};
}

std::string OutputSwitch::question(MonotonicTime now) const {
    return asked_ && now < asked_->until ? asked_->words : "";
}

}  // namespace vantage
