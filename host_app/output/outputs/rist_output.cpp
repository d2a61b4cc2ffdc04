#include "host_app/output/stream_target.h"

namespace vantage {
namespace {

OutputPlan plan(const OutputUrl& url, const OutputFormat& format) {
    url.require_options_of({"mode", "passphrase", "passphrase-file", "latency", "bitrate"});
    const NetworkPlace place = network_place_of(url);
    const std::string passphrase = passphrase_of(url);
    const bool is_listening = url.choice("mode", {"caller", "listener"}) == "listener";
    if (is_listening) require_closed_door(url, place, passphrase);
    constexpr int usual_latency_ms = 120, most_latency_ms = 8000;
    const int latency_ms =
        url.number("latency", 1, most_latency_ms, "ms").value_or(usual_latency_ms);
    StreamTarget::Settings settings{
        .url = fmt::format("rist://{}{}:{}", is_listening ? "@" : "", place.host, place.port),
        .options = {{"rist_profile", "main"},
                    {"buffer_size", std::to_string(latency_ms)},
                    {"pkt_size", "1316"}},
        .encoder = stream_encoder(url, format),
        .has_sound = format.has_sound};
    if (!passphrase.empty()) {
        settings.options.emplace_back("secret", passphrase);
        settings.options.emplace_back("encryption", "128");
    }
    return {.name = url.shown,
            .is_stream = true,
            .takes_sound = format.has_sound,
            .encoder = settings.encoder,
            .open = [settings](const OutputPatience& patience) {
                return std::make_unique<StreamTarget>(settings, patience);
            }};
}

}  // namespace

OutputEntry rist_output_entry() {
    return {"rist",
            "rist://HOST:PORT (?mode=caller or listener, passphrase-file=FILE or passphrase=..., "
            "latency=120ms, bitrate=6M)",
            plan};
}

}  // namespace vantage
