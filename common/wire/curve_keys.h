#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <sys/types.h>

namespace vantage {

/// A CURVE key pair (Curve25519) in Z85, 40 characters each. Every rig and host has one. Knowing
/// the other end's public key is required to connect to it.
struct CurveKeys {
    std::string public_key, secret_key;
};

/// Throws Error if libzmq has no CURVE support.
CurveKeys generate_curve_keys();

/// Writes a key file (TOML: version, public, secret) that only its owner can read. Throws Error if
/// the file exists.
void write_key_file(const std::filesystem::path& path, const CurveKeys& keys);

/// The owner and permissions of a key file.
struct KeyFileFacts {
    uid_t owner = 0;
    gid_t group = 0;
    mode_t mode = 0;
};
/// The users that a key file may belong to, and the groups that may read it.
struct KeyFileReader {
    std::set<uid_t> users;
    std::set<gid_t> groups;
};
/// Describes what in a key file's owner and permissions exposes the secret, with the command that
/// repairs it, without the file's name; empty if nothing. The file may belong to root or the user
/// that reads it; besides, only the service's group may read it.
std::string key_file_fault(const KeyFileFacts& file, const KeyFileReader& reader);

/// Throws Error naming the file and the mend if it is missing, readable by others or damaged, or if
/// its two keys do not belong together.
CurveKeys load_key_file(const std::filesystem::path& path);

/// Whether the text is a key: 40 characters of Z85 that decode to 32 bytes.
bool is_curve_key(std::string_view text);

/// Loads the public keys of hosts, each with the name after it on its line, or empty. One key per
/// line; empty lines and lines that begin with '#' are comments. Throws Error with file and line
/// for anything else.
std::map<std::string, std::string> load_authorized_hosts(const std::filesystem::path& path);

}  // namespace vantage
