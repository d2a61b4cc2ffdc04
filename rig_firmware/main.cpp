#include <vector>

#include "common/base/command.h"

namespace vantage {
std::vector<CommandEntry> rig_commands();
}

int main(int argc, char** argv) {
    return vantage::run_program("vantage-rig",
                                "Vantage on a rig computer: trigger, capture, match, stream",
                                vantage::rig_commands(), argc, argv);
}
