#include "host_app/output/stream_target.h"

namespace vantage {
namespace {

OutputPlan plan(const OutputUrl& url, const OutputFormat& format) {
    url.require_options_of(
        {"mode", "passphrase", "passphrase-file", "latency", "streamid", "bitrate"});
    const NetworkPlace place = network_place_of(url);
    const std::string passphrase = passphrase_of(url);
    const bool is_listening = url.choice("mode", {"caller", "listener"}) == "listener";
    if (is_listening) require_closed_door(url, place, passphrase);
    constexpr int usual_latency_ms = 120, most_latency_ms = 8000, us_a_ms = 1000;
    const int latency_ms =
        url.number("latency", 0, most_latency_ms, "ms").value_or(usual_latency_ms);
    StreamTarget::Settings settings{.url = fmt::format("srt://{}:{}", place.host, place.port),
                                    .options = {{"mode", is_listening ? "listener" : "caller"},
                                                {"latency", std::to_string(us_a_ms * latency_ms)},
                                                {"pkt_size", "1316"}},
                                    .encoder = stream_encoder(url, format),
                                    .has_sound = format.has_sound,
                                    .is_listening = is_listening};
    // libsrt reports a refused connection like a missing peer.
    if (!is_listening)
        settings.silence =
            "nobody listens there, or the listener has another passphrase or streamid";
    if (!passphrase.empty()) settings.options.emplace_back("passphrase", passphrase);
    if (const auto id = url.option("streamid")) settings.options.emplace_back("streamid", *id);
    return {.name = url.shown,
            .is_stream = true,
            .takes_sound = format.has_sound,
            .is_listening = is_listening,
            .encoder = settings.encoder,
            .open = [settings](const OutputPatience& patience) {
                return std::make_unique<StreamTarget>(settings, patience);
            }};
}

}  // namespace

OutputEntry srt_output_entry() {
    return {"srt",
            "srt://HOST:PORT (?mode=caller or listener, passphrase-file=FILE or passphrase=..., "
            "latency=120ms, streamid=..., bitrate=6M)",
            plan};
}

}  // namespace vantage
