#include "host_app/output/output_url.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include <fmt/ranges.h>

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/config/endpoint.h"

namespace vantage {
namespace {

std::string decoded(std::string_view text, const std::string& whole) {
    std::string bytes;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            bytes += text[i];
            continue;
        }
        unsigned byte = 0;
        const char* from = text.data() + i + 1;
        if (i + 2 >= text.size() || std::from_chars(from, from + 2, byte, 16).ptr != from + 2)
            fail("{}: behind a % stand two hexadecimal digits, %25 for the sign itself", whole);
        if (byte == 0) fail("{}: %00 cannot be a part of an option", whole);
        bytes += static_cast<char>(byte);
        i += 2;
    }
    return bytes;
}

bool is_scheme(std::string_view text) {
    return text.size() > 1 && std::islower(static_cast<unsigned char>(text.front())) &&
           std::all_of(text.begin(), text.end(),
                       [](unsigned char c) { return std::isdigit(c) || std::islower(c); });
}

/// Whether the option holds a passphrase, also where its name is mistyped.
bool is_secret(std::string name) {
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (name == "passphrase-file") return false;
    for (const char* part : {"pass", "phrase", "secret", "key"})
        if (name.find(part) != std::string::npos) return true;
    return false;
}

std::vector<std::string> as_strings(std::initializer_list<std::string_view> words) {
    return {words.begin(), words.end()};
}

}  // namespace

OutputUrl OutputUrl::parse(const std::string& text, const std::string& kind) {
    OutputUrl url;
    url.kind = kind;
    const std::size_t mark = text.find('?');
    const std::string front = text.substr(0, mark);
    url.shown = front;
    const std::size_t colon = front.find(':');
    if (front == "-") {
        url.scheme = "pipe";
    } else if (colon != std::string::npos && is_scheme(front.substr(0, colon))) {
        url.scheme = front.substr(0, colon);
        url.place = front.substr(colon + 1);
        if (url.place.starts_with("//")) url.place.erase(0, 2);
        if (url.scheme == "file") url.shown = url.place;
    } else {
        url.scheme = "file";
        url.place = front;
    }
    if (url.scheme != "pipe" && url.place.empty())
        fail("an output needs a file or a URL, such as srt://HOST:PORT");
    if (mark == std::string::npos) return url;
    for (std::size_t at = mark + 1; at <= text.size();) {
        const std::size_t end = std::min(text.find('&', at), text.size());
        const std::string pair = text.substr(at, end - at);
        const std::size_t equals = pair.find('=');
        const std::string name = pair.substr(0, equals);
        // The error message must not contain a secret either.
        if (equals == std::string::npos || name.empty())
            fail(
                "the {} {} has an option without a value: options are NAME=VALUE, with & "
                "between them",
                kind, front);
        url.options[name] = decoded(std::string_view(pair).substr(equals + 1), front);
        url.shown += fmt::format("{}{}={}", at == mark + 1 ? "?" : "&", name,
                                 is_secret(name) ? "***" : pair.substr(equals + 1));
        at = end + 1;
    }
    return url;
}

void OutputUrl::require_options_of(std::initializer_list<std::string_view> known) const {
    for (const auto& [name, value] : options) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        if (known.size() == 0) fail("the {} {} takes no options", kind, shown);
        fail("the {} {} has no option '{}'; {}", kind, shown, name,
             suggest_name(name, as_strings(known)));
    }
}

std::optional<std::string> OutputUrl::option(const std::string& name) const {
    const auto found = options.find(name);
    return found == options.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::int64_t> OutputUrl::bit_rate_bps() const {
    const std::optional<std::string> text = option("bitrate");
    if (!text) return std::nullopt;
    constexpr double least = 50e3, most = 500e6;
    double rate = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), rate);
    const std::string_view unit(end, text->data() + text->size());
    if (unit == "k" || unit == "K") rate *= 1e3;
    if (unit == "M") rate *= 1e6;
    if (error != std::errc() || !(unit.empty() || unit == "k" || unit == "K" || unit == "M") ||
        !(rate >= least && rate <= most))
        fail("the output {}: a bit rate is 50k to 500M bits a second, such as bitrate=6M", shown);
    return std::llround(rate);
}

std::optional<int> OutputUrl::number(const std::string& name, int least, int most,
                                     std::string_view unit) const {
    std::optional<std::string> text = option(name);
    if (!text) return std::nullopt;
    int value = 0;
    const char* last = text->data() + text->size();
    const auto [end, error] = std::from_chars(text->data(), last, value);
    const std::string_view rest(end, last);
    if (error != std::errc() || !(rest.empty() || rest == unit) || value < least || value > most)
        fail("the {} {}: {} is {} to {}{}{}", kind, shown, name, least, most,
             unit.empty() ? "" : " ", unit);
    return value;
}

std::string OutputUrl::choice(const std::string& name,
                              std::initializer_list<std::string_view> known) const {
    const std::string value = option(name).value_or(std::string(*known.begin()));
    if (std::find(known.begin(), known.end(), value) == known.end())
        fail("the {} {}: {} is {}, not '{}'", kind, shown, name, fmt::join(known, " or "), value);
    return value;
}

NetworkPlace network_place_of(const OutputUrl& url) {
    Endpoint endpoint;
    try {
        endpoint = parse_endpoint("tcp://" + url.place, url.scheme);
    } catch (const Error&) {
        endpoint.port = "*";
    }
    if (endpoint.host == "*" || endpoint.port == "*")
        fail(
            "the {} {} names no place: write {}://HOST:PORT, with 0.0.0.0 for all of this "
            "computer's addresses",
            url.kind, url.shown, url.scheme);
    return {endpoint.host, std::stoi(endpoint.port), endpoint.loopback};
}

std::string passphrase_of(const OutputUrl& url) {
    constexpr std::size_t shortest = 10, longest = 79, most_file_bytes = 1000;
    std::string phrase = url.option("passphrase").value_or("");
    if (const std::optional<std::string> file = url.option("passphrase-file")) {
        if (!phrase.empty())
            fail("the output {} has a passphrase and a passphrase-file", url.shown);
        const std::vector<std::byte> bytes = read_file(*file, most_file_bytes);
        phrase.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        while (!phrase.empty() && (phrase.back() == '\n' || phrase.back() == '\r'))
            phrase.pop_back();
    } else if (!url.option("passphrase")) {
        return "";
    }
    if (phrase.size() < shortest || phrase.size() > longest)
        fail("the output {}: a passphrase has {} to {} characters, this one has {}", url.shown,
             shortest, longest, phrase.size());
    return phrase;
}

void require_closed_door(const OutputUrl& url, const NetworkPlace& place,
                         const std::string& passphrase) {
    if (place.is_loopback || !passphrase.empty()) return;
    fail(
        "the output {} would serve whoever calls: give it a passphrase-file=FILE (or "
        "passphrase=...), or let it listen at 127.0.0.1",
        url.shown);
}

}  // namespace vantage
