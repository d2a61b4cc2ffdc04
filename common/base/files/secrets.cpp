#include "common/base/files/secrets.h"

#include <algorithm>
#include <cctype>
#include <regex>

namespace vantage {
namespace {

constexpr const char* left_out = "[left out]";
/// The length of a CURVE key in Z85 (ZeroMQ RFC 32).
constexpr std::size_t key_chars = 40;

bool is_z85(char c) {
    constexpr std::string_view others = ".-:+=^!/*?&<>()[]{}@%$#";
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           others.find(c) != std::string_view::npos;
}

/// Whether the text is a URL or a path rather than a key: it has no character that only keys have,
/// and begins with a scheme or a slash. A key may begin like that, too, but text as long as a key
/// has more slashes if it is a path.
bool is_url_or_path(std::string_view run) {
    constexpr std::string_view others = "/.-+@=:?&%#";
    const auto is_usual = [&](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               others.find(c) != std::string_view::npos;
    };
    const bool has_begin = run.front() == '/' || run.find("://") != std::string_view::npos;
    return has_begin && std::all_of(run.begin(), run.end(), is_usual) &&
           (run.size() != key_chars || std::count(run.begin(), run.end(), '/') > 1);
}

/// Whether the text has a capital, a small letter and a digit, which dates and checksums lack.
bool looks_like_key(std::string_view run) {
    const auto has = [&](int (*kind)(int)) {
        return std::any_of(run.begin(), run.end(),
                           [&](char c) { return kind(static_cast<unsigned char>(c)) != 0; });
    };
    return has(std::isupper) && has(std::islower) && has(std::isdigit);
}

/// Replaces runs of at least 40 Z85 characters that may contain a key.
std::string without_keys(std::string_view text) {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && is_z85(text[end])) ++end;
        const std::string_view run = text.substr(at, end - at);
        if (run.size() >= key_chars && looks_like_key(run) && !is_url_or_path(run))
            out += left_out;
        else
            out += run;
        if (end < text.size()) out += text[end++];
        at = end;
    }
    return out;
}

}  // namespace

std::string without_secrets(std::string_view text) {
    constexpr auto flags = std::regex::icase | std::regex::optimize;
    // A name may have a prefix (srt_passphrase, public_key). A name that ends in _file is a path.
    static const std::regex quoted(
        R"(((?:key|public|secret|passphrase|password|token|streamid)["']?\s*[=:]\s*)("[^"\n]*"|'[^'\n]*'))",
        flags);
    static const std::regex plain(
        R"(((?:secret|passphrase|password|token|streamid)["']?\s*[=:\s]\s*)([^\s"'&,\[\]}]+))",
        flags);
    static const std::regex in_url(R"((://)[^/@\s"']+@)", flags);
    std::string out(text);
    out = std::regex_replace(out, in_url, std::string("$1") + left_out + "@");
    out = std::regex_replace(out, quoted, std::string("$1\"") + left_out + "\"");
    out = std::regex_replace(out, plain, std::string("$1") + left_out);
    return without_keys(out);
}

}  // namespace vantage
