#pragma once

namespace CLI {
class App;
}

namespace vantage {

/// `keys new FILE` and `keys show FILE`, the same on rig and host: make a key pair, print its
/// public half.
void add_keys_command(CLI::App& program);

}  // namespace vantage
