#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace vantage {

/// A CURVE key pair (Curve25519) in Z85, 40 characters each. Rigs and hosts have one each; who
/// knows the other's public key can talk to it.
struct CurveKeys {
    std::string public_key, secret_key;
};

/// Throws Error if this computer's libzmq has no CURVE.
CurveKeys generate_curve_keys();

/// Writes a key file (TOML: version, public, secret) that only its owner can read. Throws Error
/// rather than overwrite what stands there.
void write_key_file(const std::filesystem::path& path, const CurveKeys& keys);

/// Throws Error naming file and mend for what is missing, readable by others, damaged, or a pair
/// whose halves do not belong together.
CurveKeys load_key_file(const std::filesystem::path& path);

/// 40 characters of Z85 that decode to 32 bytes.
bool is_curve_key(std::string_view text);

/// Public keys of hosts, each with the name that follows it on its line (or empty): one key a line,
/// then any words; empty lines and lines that begin with '#', which no key does, are comments.
/// Throws Error with file and line for anything else.
std::map<std::string, std::string> load_authorized_hosts(const std::filesystem::path& path);

}  // namespace vantage
