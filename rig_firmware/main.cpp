#include <string_view>
#include <vector>

#include "common/base/cli/command.h"

namespace vantage {
std::string_view commit();
std::vector<CommandEntry> rig_commands();
}  // namespace vantage

int main(int argc, char** argv) {
    return vantage::run_program(
        {.name = "vantage-rig",
         .description = "Vantage on a rig computer: trigger, capture, match, stream",
         .commit = vantage::commit(),
         .libraries = VANTAGE_LIBRARIES},
        vantage::rig_commands(), argc, argv);
}
