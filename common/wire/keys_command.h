#pragma once

namespace CLI {
class App;
}

namespace vantage {

/// Adds `keys new FILE` and `keys show FILE`, which are the same on rig and host: create a key
/// pair, print its public key.
void add_keys_command(CLI::App& program);

}  // namespace vantage
