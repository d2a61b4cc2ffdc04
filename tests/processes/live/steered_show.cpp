#include "tests/processes/live/steered_show.h"

#include <cstdlib>

#include <fmt/format.h>

#include "tests/support/eventually.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

std::vector<std::string> steered(std::vector<std::string> arguments, int port, int lamps) {
    arguments.insert(arguments.end(),
                     {"--control", fmt::format("osc://:{}?lamps=127.0.0.1:{}", port, lamps)});
    return arguments;
}

}  // namespace

SteeredShow::SteeredShow(std::vector<std::string> arguments, const TemporaryFolder& folder)
    : SteeredShow(std::move(arguments), folder, two_free_ports()) {}

SteeredShow::SteeredShow(std::vector<std::string> arguments, const TemporaryFolder& folder,
                         std::pair<int, int> ports)
    : port_(ports.first),
      watcher_("/usr/bin/stdbuf", {"-oL", "oscdump", std::to_string(ports.second)}, folder.path()),
      show_(VANTAGE_PROGRAM, steered(std::move(arguments), ports.first, ports.second),
            folder.path()) {}

bool SteeredShow::send(const std::string& words) const {
    return std::system(fmt::format("oscsend 127.0.0.1 {} {}", port_, words).c_str()) == 0;
}

bool SteeredShow::is_told(const std::string& words) const {
    return eventually([&] { return watcher_.out().find(words) != std::string::npos; });
}

std::string SteeredShow::lamp(const std::string& name) const {
    const std::string told = watcher_.out();
    const std::size_t at = told.rfind("/vantage/lamp/" + name + " ");
    const std::size_t end = told.find('\n', at);
    if (at == std::string::npos || end == std::string::npos) return "";
    // The address, the letter of the type, the value.
    const std::size_t type = told.find(' ', at) + 1;
    std::string value = told.substr(type + 2, end - type - 2);
    if (value.size() > 1 && value.front() == '"') return value.substr(1, value.size() - 2);
    if (value.find('.') != std::string::npos) {
        value.erase(value.find_last_not_of('0') + 1);
        if (value.ends_with('.')) value.pop_back();
    }
    return value;
}

testing::AssertionResult SteeredShow::shows(const std::string& name,
                                            const std::string& value) const {
    if (eventually([&] { return lamp(name) == value; })) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << name << " is " << lamp(name) << ", not " << value << "; notice: " << lamp("notice");
}

bool SteeredShow::goes_past(const std::string& name, double value) const {
    return eventually([&] {
        const std::string now = lamp(name);
        return !now.empty() && std::stod(now) > value;
    });
}

Clip saved_clip(const std::filesystem::path& file, int number, double pulse_rate_hz) {
    ClipBook book;
    EXPECT_TRUE(eventually([&] {
        if (!std::filesystem::exists(file)) return false;
        book = load_clips(file, pulse_rate_hz);
        return book.clips.contains(number);
    })) << file
        << " has no clip " << number;
    return book.clips[number];
}

}  // namespace vantage
