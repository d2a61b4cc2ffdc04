#pragma once

namespace CLI {
class App;
}

namespace vantage {

/// `vantage rigs plan`: whether the networks carry what the rigs send.
void add_rigs_plan(CLI::App& rigs);

}  // namespace vantage
