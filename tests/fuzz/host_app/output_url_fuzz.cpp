#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "common/base/error.h"
#include "host_app/output/output_url.h"

/// A URL of an output as somebody types it, with every question that outputs ask about it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (text.find('\0') != std::string::npos) return 0;  // no command line has one
    OutputUrl url;
    try {
        url = OutputUrl::parse(text);
    } catch (const Error&) {
        return 0;
    }
    if (url.scheme.empty() || (url.scheme != "pipe" && url.place.empty())) std::abort();
    for (const auto& [name, value] : url.options)
        if (name.empty() || value.find('\0') != std::string::npos) std::abort();
    // The text that logs show ends with "***" in place of a passphrase.
    constexpr std::size_t long_enough = 10;
    if (const auto phrase = url.option("passphrase"); phrase && phrase->size() >= long_enough)
        if (url.shown.find(*phrase) != std::string::npos &&
            text.find(*phrase) == text.rfind(*phrase))
            std::abort();
    const auto ask = [](const auto& question) {
        try {
            question();
        } catch (const Error&) {
        }
    };
    ask([&] {
        const auto rate = url.bit_rate_bps();
        if (rate && (*rate < 50'000 || *rate > 500'000'000)) std::abort();
    });
    ask([&] {
        const auto latency = url.number("latency", 20, 8000, "ms");
        if (latency && (*latency < 20 || *latency > 8000)) std::abort();
    });
    ask([&] { (void)url.choice("mode", {"caller", "listener"}); });
    ask([&] { url.require_options_of({"mode", "latency", "passphrase"}); });
    ask([&] {
        const NetworkPlace place = network_place_of(url);
        if (place.port < 1 || place.port > 65535 || place.host.empty()) std::abort();
        require_closed_door(url, place, "");
    });
    if (!url.option("passphrase-file")) ask([&] { (void)passphrase_of(url); });
    return 0;
}
