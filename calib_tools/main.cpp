#include <vector>

#include "common/base/command.h"

namespace vantage {
std::vector<CommandEntry> calib_commands();
}

int main(int argc, char** argv) {
    return vantage::run_program("vantage-calib", "Vantage calibration: boards, rigs, stages",
                                vantage::calib_commands(), argc, argv);
}
