#pragma once

namespace CLI {
class App;
}

namespace vantage {

/// `vantage rigs update`: which versions the rigs run, and what brings them to this host's.
void add_rigs_update(CLI::App& rigs);

}  // namespace vantage
