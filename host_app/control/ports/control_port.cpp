#include "host_app/control/ports/control_port.h"

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/refused_inputs.h"

namespace vantage {

std::unique_ptr<ControlPort> open_port(const std::string& text, const ControlBench& bench) {
    const OutputUrl url = OutputUrl::parse(text, "control");
    std::vector<std::string> schemes;
    for (const PortEntry& entry : port_entries()) {
        if (entry.scheme == url.scheme) return entry.open(url, bench);
        schemes.push_back(entry.scheme);
    }
    fail("the control {} is of no kind there is; {}", url.shown, suggest_name(url.scheme, schemes));
}

void ControlPort::refuse_input(std::string_view protocol, std::span<const std::byte> input,
                               std::string sentence) {
    note_refused_input(protocol, input, sentence);
    refuse(&PortStats::malformed, std::move(sentence));
}

NetworkPlace listening_place_of(OutputUrl url) {
    if (url.place.starts_with(':')) url.place.insert(0, "127.0.0.1");
    NetworkPlace place = network_place_of(url);
    const bool is_open = url.choice("open", {"no", "yes"}) == "yes";
    if (!place.is_loopback && !is_open)
        fail(
            "the {} {} would serve whoever reaches this computer: say open=yes if that is meant, "
            "or let it listen at 127.0.0.1",
            url.kind, url.shown);
    if (!place.is_loopback)
        log_warning("the {} {} serves whoever reaches this computer on port {}", url.kind,
                    url.shown, place.port);
    return place;
}

}  // namespace vantage
