#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "host_app/control/ports/control_port.h"
#include "tests/support/free_ports.h"
#include "tests/unit/host_app/ports/local_socket.h"

namespace vantage {

/// A bench without a session behind it, and a port on it that is served by hand.
class BenchTest : public testing::Test {
  protected:
    std::unique_ptr<ControlPort> open(const std::string& scheme, const std::string& options = "") {
        return open_port(fmt::format("{}://127.0.0.1:{}{}", scheme, number_, options), bench_);
    }
    /// Until the port has counted so many messages, two seconds at the most.
    static void serve(ControlPort& port, std::uint64_t messages) {
        for (int i = 0; i < 100 && all(port.stats()) < messages; ++i)
            port.serve(std::chrono::milliseconds(20));
    }
    static std::uint64_t all(const PortStats& stats) {
        return stats.obeyed + stats.unknown + stats.malformed + stats.dropped;
    }

    const int number_ = two_free_ports().first;
    OperatorInputBox operator_input_;
    TrackedCamera tracked_;
    Tally tally_;
    LampBoard lamps_;
    LtcBoard ltc_;
    ControlBench bench_{operator_input_, tracked_, tally_, lamps_, ltc_};
    LocalSocket peer_;
};

}  // namespace vantage
