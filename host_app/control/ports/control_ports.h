#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "host_app/control/ports/control_port.h"

namespace vantage {

/// A port and what it counted.
struct PortState {
    std::string name;
    PortStats stats;
    std::string failure;  ///< empty: it works
};

/// The ports of a session, each on a thread of its own. One that fails does so alone.
class ControlPorts {
  public:
    /// Throws Error for a URL that cannot be, or a place that is taken.
    ControlPorts(const std::vector<std::string>& urls, const ControlBench& bench);
    ~ControlPorts();
    ControlPorts(const ControlPorts&) = delete;
    ControlPorts& operator=(const ControlPorts&) = delete;

    /// Ends them all; what they counted stays.
    void close();
    std::vector<PortState> states() const;

  private:
    struct Port {
        std::unique_ptr<ControlPort> port;
        PortState state;
        std::thread thread;
    };
    void run(Port& port);

    mutable std::mutex mutex_;  ///< of the states
    std::atomic<bool> is_ending_ = false;
    std::vector<std::unique_ptr<Port>> ports_;
};

}  // namespace vantage
