#pragma once

#include <filesystem>
#include <fstream>

#include "common/config/rig_config.h"
#include "common/wire/curve_keys.h"

namespace vantage {

/// Makes keys for a rig and a host in this folder. Returns the stream of the rig, which admits the
/// host, whose key is `host.key`.
inline RigConfig::Stream keyed_stream(const std::filesystem::path& folder) {
    const CurveKeys host_keys = generate_curve_keys();
    write_key_file(folder / "host.key", host_keys);
    RigConfig::Stream stream;
    stream.key_file = folder / "rig.key";
    write_key_file(stream.key_file, generate_curve_keys());
    stream.authorized_hosts = folder / "hosts.keys";
    std::ofstream(stream.authorized_hosts) << host_keys.public_key << " the host\n";
    return stream;
}

}  // namespace vantage
