#include <string_view>
#include <vector>

#include "common/base/cli/command.h"

namespace vantage {
std::string_view commit();
std::vector<CommandEntry> calib_commands();
}  // namespace vantage

int main(int argc, char** argv) {
    return vantage::run_program({.name = "vantage-calib",
                                 .description = "Vantage calibration: boards, rigs, stages",
                                 .commit = vantage::commit(),
                                 .libraries = VANTAGE_LIBRARIES},
                                vantage::calib_commands(), argc, argv);
}
