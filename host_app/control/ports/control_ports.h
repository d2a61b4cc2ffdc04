#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "host_app/control/ports/control_port.h"

namespace vantage {

/// State and counters of one port.
struct PortState {
    std::string name;
    PortStats stats;
    std::string failure;  ///< empty while the port works
};

/// All control ports of a session, each on a thread of its own. A port that fails does not affect
/// the others.
class ControlPorts {
  public:
    /// Opens all ports. Throws Error for an invalid URL or a place that is taken.
    ControlPorts(const std::vector<std::string>& urls, const ControlBench& bench);
    ~ControlPorts();
    ControlPorts(const ControlPorts&) = delete;
    ControlPorts& operator=(const ControlPorts&) = delete;

    /// Closes all ports; their counters stay readable.
    void close();
    std::vector<PortState> states() const;

  private:
    struct Port {
        std::unique_ptr<ControlPort> port;
        PortState state;
        std::thread thread;
    };
    void run(Port& port);

    mutable std::mutex mutex_;  ///< guards the states
    std::atomic<bool> is_ending_ = false;
    std::vector<std::unique_ptr<Port>> ports_;
};

}  // namespace vantage
