#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/config/rig_config.h"
#include "common/pairing/pair_message.h"
#include "common/wire/curve_keys.h"

namespace vantage {

/// The files of a rig that say whom it trusts: its key pair, its list of hosts, and rig.toml, which
/// names both. As root, what is written is the service's to read.
class PairedFiles {
  public:
    /// Those that the configuration names, else rig.key and hosts.keys beside it. Throws Error for
    /// a configuration that cannot be.
    explicit PairedFiles(std::filesystem::path config);

    const RigConfig& config() const { return config_; }
    const std::filesystem::path& hosts_file() const { return hosts_file_; }
    /// The rig's own, made and written where there is none.
    CurveKeys own_keys() const;

    /// Lets the host in: its key goes into the list, and rig.toml is told of key and list where it
    /// does not name them. `for_others`: a stream that only this computer reaches is opened to
    /// others. Returns what of rig.toml has changed, as it stands there; empty: nothing, and a
    /// running daemon takes the host in as it is.
    std::vector<std::string> admit(const PairReveal& host, bool for_others);

  private:
    std::filesystem::path file_, key_file_, hosts_file_;
    RigConfig config_;
};

}  // namespace vantage
