#include "host_app/control/ports/control_port.h"

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/log_limiter.h"
#include "common/base/refused_inputs.h"
#include "common/base/this_thread.h"

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

namespace {

constexpr std::chrono::milliseconds look{20};
constexpr std::chrono::seconds refusals_are_told_every{10};

}  // namespace

ControlPorts::ControlPorts(const std::vector<std::string>& urls, const ControlBench& bench) {
    for (const std::string& url : urls) {
        auto port = std::make_unique<Port>();
        port->state.name = OutputUrl::parse(url, "control").shown;
        port->port = open_port(url, bench);
        ports_.push_back(std::move(port));
    }
    // Threads start only once all ports are open.
    for (const std::unique_ptr<Port>& port : ports_)
        port->thread = std::thread([this, &port = *port] { run(port); });
}

ControlPorts::~ControlPorts() { close(); }

void ControlPorts::close() {
    is_ending_ = true;
    for (const std::unique_ptr<Port>& port : ports_)
        if (port->thread.joinable()) port->thread.join();
}

void ControlPorts::run(Port& port) {
    name_this_thread("control");
    LogLimiter refusals(refusals_are_told_every);
    std::uint64_t told = 0;
    try {
        while (!is_ending_) {
            port.port->serve(look);
            const PortStats& stats = port.port->stats();
            const std::uint64_t refused = stats.unknown + stats.malformed;
            if (const auto since = refusals.count(refused - told, MonotonicClock::now()))
                log_warning("control {}: {} messages not obeyed, the last: {}", port.state.name,
                            *since, stats.last_refusal);
            told = refused;
            const std::lock_guard lock(mutex_);
            port.state.stats = stats;
        }
    } catch (const Error& error) {
        log_error("{}", error.what());
        const std::lock_guard lock(mutex_);
        port.state.failure = error.what();
    }
}

std::vector<PortState> ControlPorts::states() const {
    const std::lock_guard lock(mutex_);
    std::vector<PortState> states;
    for (const std::unique_ptr<Port>& port : ports_) states.push_back(port->state);
    return states;
}

}  // namespace vantage
