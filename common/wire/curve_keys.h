#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <sys/types.h>

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

/// Whose a key file is, and who may do what with it.
struct KeyFileFacts {
    uid_t owner = 0;
    gid_t group = 0;
    mode_t mode = 0;
};
/// Who a key file may belong to, and which groups may read it.
struct KeyFileReader {
    std::set<uid_t> users;
    std::set<gid_t> groups;
};
/// What of a key file's owner and permissions gives the secret away, with the command that mends it
/// but for the file's name; empty if nothing does. It belongs to root or who reads it; besides its
/// owner at most the service's group reads it.
std::string key_file_fault(const KeyFileFacts& file, const KeyFileReader& reader);

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
