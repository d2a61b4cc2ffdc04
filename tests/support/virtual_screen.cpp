#include "tests/support/virtual_screen.h"

#include <chrono>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr const char* server_program = "/usr/bin/Xvfb";
constexpr const char* operator_input_program = "/usr/bin/xdotool";

}  // namespace

bool VirtualScreen::is_there() {
    return std::filesystem::exists(server_program) &&
           std::filesystem::exists(operator_input_program);
}

VirtualScreen::VirtualScreen(int width_px, int height_px) {
    // It chooses a free display number and prints it to its standard output.
    server_ = std::make_unique<ChildProgram>(
        server_program,
        std::vector<std::string>{"-displayfd", "1", "-nolisten", "tcp", "-screen", "0",
                                 fmt::format("{}x{}x24", width_px, height_px)},
        folder_.path());
    for (int tries = 0; tries < 3000; ++tries) {
        const std::string said = server_->out();
        if (!said.empty() && said.back() == '\n') {
            display_ = ":" + said.substr(0, said.size() - 1);
            return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    fail("Xvfb does not come up: {}", server_->err());
}

void VirtualScreen::operator_input(const std::vector<std::string>& commands) const {
    const ProgramResult result = run_to_end(operator_input_program, commands, {environment()});
    if (result.status != 0) fail("xdotool: {}", result.err);
}

}  // namespace vantage
