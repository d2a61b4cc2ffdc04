#include "host_app/session/output_switch.h"

namespace vantage {
namespace {

/// How long a question is shown.
constexpr std::chrono::seconds question_duration{3};
/// The function key of output 1.
constexpr int first_output_key = 5;

}  // namespace

void OutputSwitch::press(int number, MonotonicTime now) {
    const auto at = static_cast<std::size_t>(number - 1);
    const std::vector<OutputState> states = outputs_.states();
    if (number < 1 || at >= states.size()) {
        asked_ = {number, fmt::format("There is no output {}; add it with --output", number),
                  now + question_duration};
        return;
    }
    const bool runs = outputs_.is_wanted(at);
    const bool is_second = asked_ && asked_->number == number && now < asked_->until;
    asked_.reset();
    if (!runs)
        outputs_.start(at);
    else if (is_second)
        outputs_.stop(at);
    else
        asked_ = {number,
                  fmt::format("Press F{} again to stop {}", first_output_key + number - 1,
                              states[at].name),
                  now + question_duration};
}

std::string OutputSwitch::question(MonotonicTime now) const {
    return asked_ && now < asked_->until ? asked_->words : "";
}

}  // namespace vantage
