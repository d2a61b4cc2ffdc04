#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host_app/control/ports/control_bench.h"
#include "host_app/output/output_url.h"

namespace vantage {

/// Every message that came is in one of these.
struct PortStats {
    std::uint64_t obeyed = 0;
    std::uint64_t unknown = 0;    ///< well formed, and there is no such command
    std::uint64_t malformed = 0;  ///< not what the protocol says, or an argument that does not fit
    std::uint64_t dropped = 0;    ///< more than may come
    std::string last_refusal;     ///< the latest that was unknown or malformed, for people
    std::string told;             ///< what came last, for people, where that is not a command
};

/// Something that listens for others who steer, or tell of what is steered. Made, served and
/// destroyed on one thread each.
class ControlPort {
  public:
    virtual ~ControlPort() = default;
    /// Takes what has come, waiting for so long at the most. Throws Error if it cannot go on.
    virtual void serve(std::chrono::milliseconds most) = 0;
    const PortStats& stats() const { return stats_; }

  protected:
    /// Told back to people: what a stranger wrote, without what a terminal obeys.
    static std::string printable(std::string text) {
        for (char& c : text)
            if (c < ' ' || c > '~') c = '?';
        return text;
    }
    void refuse(std::uint64_t PortStats::*counter, std::string sentence) {
        ++(stats_.*counter);
        stats_.last_refusal = std::move(sentence);
    }
    /// Counts an input that the protocol does not allow, and keeps it for bug reports.
    void refuse_input(std::string_view protocol, std::span<const std::byte> input,
                      std::string sentence);
    PortStats stats_;
};

/// A kind of port. A backend is a file kinds/NAME_port.cpp with `NAME_port_entry()`.
struct PortEntry {
    std::string scheme;
    std::string words;  ///< how its URL is written, for people
    /// Throws Error for what cannot be, or is taken.
    std::function<std::unique_ptr<ControlPort>(const OutputUrl& url, const ControlBench& bench)>
        open;
};
std::vector<PortEntry> port_entries();

/// Opens whichever kind the URL is of. Throws Error, also for a URL of no kind.
std::unique_ptr<ControlPort> open_port(const std::string& url, const ControlBench& bench);

/// Where a port listens: loopback where the URL has no host. Throws Error for an address beyond
/// this computer that is not followed by `open=yes`.
NetworkPlace listening_place_of(OutputUrl url);

}  // namespace vantage
