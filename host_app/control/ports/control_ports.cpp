#include "host_app/control/ports/control_ports.h"

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/log_limiter.h"
#include "common/base/this_thread.h"

namespace vantage {
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
