#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// URL of an output on the command line: "SCHEME:PLACE", "SCHEME://PLACE" or a file name. Options
/// follow a '?' as "NAME=VALUE&...", and %XX in a value is a byte.
struct OutputUrl {
    std::string scheme;  ///< "file" for a file name, "pipe" for "-"
    std::string place;
    std::map<std::string, std::string> options;
    std::string shown;  ///< as written, without secrets
    std::string kind;   ///< name of its kind in error messages

    /// Throws Error for an invalid URL.
    static OutputUrl parse(const std::string& text, const std::string& kind = "output");

    /// Throws Error with the first option that is not in the list.
    void require_options_of(std::initializer_list<std::string_view> known) const;
    std::optional<std::string> option(const std::string& name) const;
    /// Bit rate "6M", "800k", "25000000". Throws Error if it is not valid.
    std::optional<std::int64_t> bit_rate_bps() const;
    /// Integer option within these limits, e.g. "120", optionally followed by `unit`. Throws Error
    /// if it is not valid.
    std::optional<int> number(const std::string& name, int least, int most,
                              std::string_view unit = "") const;
    /// Option with one of these values; the first is the default. Throws Error for any other value.
    std::string choice(const std::string& name,
                       std::initializer_list<std::string_view> known) const;
};

/// Host and port on a network.
struct NetworkPlace {
    std::string host;  ///< with brackets for an IPv6 address
    int port = 0;
    bool is_loopback = false;
};

/// Parses "HOST:PORT" of the URL. Throws Error if it is not valid.
NetworkPlace network_place_of(const OutputUrl& url);

/// Passphrase from the options `passphrase` or `passphrase-file`; empty if there is none. Throws
/// Error if its length is not valid for SRT and RIST, or if the file cannot be read.
std::string passphrase_of(const OutputUrl& url);

/// Throws Error for an output that listens beyond this computer without a passphrase.
void require_closed_door(const OutputUrl& url, const NetworkPlace& place,
                         const std::string& passphrase);

}  // namespace vantage
