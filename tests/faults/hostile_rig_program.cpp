// A rig that attacks every host that connects, until it is killed (see HostileRig). Prints the
// lines of its entry in a stage file.
#include <chrono>
#include <cstdlib>
#include <iostream>

#include <fmt/format.h>
#include <unistd.h>

#include "tests/faults/hostile_rig.h"

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "hostile_rig: needs the stage's pulses per second and a seed\n";
        return 2;
    }
    const std::chrono::duration<double> period_s(1 / std::atof(argv[1]));
    const vantage::HostileRig rig("hostile",
                                  std::chrono::duration_cast<std::chrono::nanoseconds>(period_s),
                                  static_cast<unsigned>(std::atoi(argv[2])));
    std::cout << fmt::format(
                     "[[rigs]]\nname = \"hostile\"\nendpoint = \"{}\"\npublic_key = \"{}\"\n",
                     rig.endpoint(), rig.public_key())
              << std::flush;
    for (;;) ::pause();
}
