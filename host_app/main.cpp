#include <string_view>
#include <vector>

#include "common/base/cli/command.h"

namespace vantage {
std::string_view commit();
std::vector<CommandEntry> host_commands();
}  // namespace vantage

int main(int argc, char** argv) {
    return vantage::run_program({.name = "vantage",
                                 .description = "Vantage on the host: receive, fuse, fly, put out",
                                 .commit = vantage::commit(),
                                 .libraries = VANTAGE_LIBRARIES,
                                 .returns_large_blocks = true},
                                vantage::host_commands(), argc, argv);
}
