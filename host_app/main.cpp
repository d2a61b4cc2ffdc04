#include <vector>

#include "common/base/command.h"

namespace vantage {
std::vector<CommandEntry> host_commands();
}

int main(int argc, char** argv) {
    return vantage::run_program("vantage", "Vantage on the host: receive, fuse, fly, put out",
                                vantage::host_commands(), argc, argv);
}
