#include "host_app/control/hid/simulated/simulated_xpress.h"

#include <sstream>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr int last_notch = 7, most_detents = 100, buttons = 5, first_button_bit = 4;

}  // namespace

SimulatedXpress::Report SimulatedXpress::report(std::uint16_t held) const {
    return {static_cast<std::uint8_t>(ring_), counter_, 0, static_cast<std::uint8_t>(held & 0xff),
            static_cast<std::uint8_t>(held >> 8)};
}

std::vector<SimulatedXpress::Report> SimulatedXpress::reports_of(const std::string& line) {
    std::istringstream text(line);
    std::string control, more;
    text >> control;
    const auto number = [&](int most) {
        int value = 0;
        if (!(text >> value) || value < -most || value > most)
            fail("'{}' is not understood: after '{}' comes a number from {} to {}", line, control,
                 -most, most);
        return value;
    };
    std::vector<Report> reports{report()};
    if (control == "jog") {
        const int detents = number(most_detents);
        for (int i = 0; i != detents; i += detents > 0 ? 1 : -1) {
            counter_ = static_cast<std::uint8_t>(counter_ + (detents > 0 ? 1 : -1));
            reports.push_back(report());
        }
    } else if (control == "shuttle") {
        ring_ = static_cast<std::int8_t>(number(last_notch));
        reports.push_back(report());
    } else if (control.size() == 2 && control[0] == 'b' && control[1] > '0' &&
               control[1] <= '0' + buttons) {
        const int bit = first_button_bit + control[1] - '1';
        reports.push_back(report(static_cast<std::uint16_t>(1U << static_cast<unsigned>(bit))));
        reports.push_back(report());
    } else {
        fail("'{}' is not understood; words are: {}", line, words);
    }
    if (text >> more) fail("'{}' is not understood: nothing comes after '{}'", line, control);
    return reports;
}

}  // namespace vantage
