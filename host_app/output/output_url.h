#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// Where an output goes, as it is written on a command line: "SCHEME:PLACE", "SCHEME://PLACE" or
/// the name of a file, and behind a '?' options, "NAME=VALUE&...", in whose values %XX is a byte.
struct OutputUrl {
    std::string scheme;  ///< "file" for the name of a file, "pipe" for "-"
    std::string place;
    std::map<std::string, std::string> options;
    std::string shown;  ///< as it was written, but for what is secret
    std::string kind;   ///< what sentences about it call it

    /// Throws Error for what is no such thing.
    static OutputUrl parse(const std::string& text, const std::string& kind = "output");

    /// Throws Error naming the option that is none of these.
    void require_options_of(std::initializer_list<std::string_view> known) const;
    std::optional<std::string> option(const std::string& name) const;
    /// "6M", "800k", "25000000". Throws Error for what is no such rate.
    std::optional<std::int64_t> bit_rate_bps() const;
    /// A whole number within these limits, "120", that `unit` may stand behind. Throws Error for
    /// what is none.
    std::optional<int> number(const std::string& name, int least, int most,
                              std::string_view unit = "") const;
    /// Of one of these, the first where it is not given. Throws Error for what is none of them.
    std::string choice(const std::string& name,
                       std::initializer_list<std::string_view> known) const;
};

/// A place on a network.
struct NetworkPlace {
    std::string host;  ///< with brackets where it is an IPv6 address
    int port = 0;
    bool is_loopback = false;
};

/// "HOST:PORT" of the URL. Throws Error for what is no such place.
NetworkPlace network_place_of(const OutputUrl& url);

/// The passphrase of the options `passphrase` or `passphrase-file`; empty: none. Throws Error if it
/// is too short or long for SRT and RIST, or the file cannot be read.
std::string passphrase_of(const OutputUrl& url);

/// Throws Error for what listens beyond this computer without a passphrase.
void require_closed_door(const OutputUrl& url, const NetworkPlace& place,
                         const std::string& passphrase);

}  // namespace vantage
