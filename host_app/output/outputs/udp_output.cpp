#include "host_app/output/stream_target.h"

namespace vantage {
namespace {

OutputPlan plan(const OutputUrl& url, const OutputFormat& format) {
    url.require_options_of({"ttl", "bitrate"});
    const NetworkPlace place = network_place_of(url);
    constexpr int usual_ttl = 1, most_ttl = 255;
    StreamTarget::Settings settings{
        .url = fmt::format("udp://{}:{}", place.host, place.port),
        .options = {{"pkt_size", "1316"},
                    {"ttl", std::to_string(url.number("ttl", 1, most_ttl).value_or(usual_ttl))}},
        .encoder = stream_encoder(url, format),
        .has_sound = format.has_sound};
    return {.name = url.shown,
            .is_stream = true,
            .takes_sound = format.has_sound,
            .encoder = settings.encoder,
            .open = [settings](const OutputPatience& patience) {
                return std::make_unique<StreamTarget>(settings, patience);
            }};
}

}  // namespace

OutputEntry udp_output_entry() {
    return {"udp", "udp://HOST:PORT (MPEG-TS; a group too, ?ttl=1, bitrate=6M)", plan};
}

}  // namespace vantage
