#include "host_app/desk/panels/command_prompt.h"

#include <algorithm>

#include "common/base/error.h"

namespace vantage {

void CommandPrompt::type(unsigned codepoint) {
    constexpr std::size_t max_letters = 64;
    constexpr unsigned last_of_ascii = 126;
    if (codepoint < ' ' || codepoint > last_of_ascii || typed_.size() >= max_letters) return;
    typed_ += static_cast<char>(codepoint);
    fault_.clear();
}

void CommandPrompt::erase() {
    if (!typed_.empty()) typed_.pop_back();
    fault_.clear();
}

void CommandPrompt::complete() {
    std::optional<std::string> common;
    for (const ControlCommand& command : control_commands()) {
        const std::string name = command.name;
        if (!name.starts_with(typed_)) continue;
        if (!common) {
            common = name;
            continue;
        }
        const auto [end, ignored] =
            std::mismatch(common->begin(), common->end(), name.begin(), name.end());
        common->erase(end, common->end());
    }
    if (common) typed_ = *common;
}

std::optional<CommandCall> CommandPrompt::call() {
    try {
        return parse_typed_command(typed_);
    } catch (const Error& error) {
        fault_ = error.what();
        return std::nullopt;
    }
}

std::string CommandPrompt::line() const {
    return "> " + typed_ + "_" + (fault_.empty() ? "" : "   " + fault_);
}

}  // namespace vantage
