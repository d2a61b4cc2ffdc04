#pragma once

namespace CLI {
class App;
}

namespace vantage {

/// `vantage rigs bugreport`: one archive for whoever is to help.
void add_rigs_bugreport(CLI::App& rigs);

}  // namespace vantage
