#include <map>
#include <thread>

#include <fmt/format.h>

#include "host_app/control/ports/control_port.h"
#include "host_app/control/ports/messages/rosstalk.h"
#include "host_app/control/ports/sockets.h"

namespace vantage {
namespace {

constexpr std::size_t most_peers = 8;
constexpr int usual_port = 7788, most_lines_a_look = 256;

/// Fills in the protocol's default port.
OutputUrl with_port(OutputUrl url) {
    const bool has_port = url.place.rfind(':') != std::string::npos && !url.place.ends_with(']');
    if (!has_port) url.place += fmt::format(":{}", usual_port);
    return url;
}

class RossTalkPort final : public ControlPort {
  public:
    RossTalkPort(const OutputUrl& url, const ControlBench& bench)
        : intake_(bench.operator_input),
          map_(RossTalkMap::load(url.option("map").value_or(""))),
          listener_(listening_place_of(with_port(url)), "control " + url.shown, most_peers) {
        url.require_options_of({"open", "map"});
    }

    void serve(std::chrono::milliseconds most) override {
        int lines = 0;
        for (const TcpListener::Arrived& arrived : listener_.receive(most)) {
            if (arrived.bytes.empty()) {
                if (const std::string& rest = lines_[arrived.peer].rest(); !rest.empty())
                    refuse(&PortStats::malformed,
                           fmt::format("'{}' without the end of a line, before the connection was "
                                       "closed",
                                       printable(rest)));
                lines_.erase(arrived.peer);
                continue;
            }
            LineSplitter& waiting = lines_[arrived.peer];
            waiting.take(arrived.bytes);
            while (const std::optional<std::string> line = waiting.next()) {
                obey(*line, MonotonicClock::now());
                ++lines;
            }
            if (!waiting.is_flooded()) continue;
            refuse(&PortStats::malformed,
                   fmt::format("more than {} bytes without the end of a line, after which the "
                               "connection is closed",
                               LineSplitter::most_line_bytes));
            lines_.erase(arrived.peer);
            listener_.close(arrived.peer);
        }
        stats_.dropped += listener_.turned_away() - seen_turned_away_;
        seen_turned_away_ = listener_.turned_away();
        // In a flood the port pauses: TCP slows the sender down, and rendering keeps the processor.
        if (lines >= most_lines_a_look) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }

  private:
    void obey(const std::string& line, MonotonicTime now) {
        const RossTalkLine said = parse_rosstalk(line);
        if (!said.order) {
            const std::string sentence =
                fmt::format("'{}' is {}", printable(line),
                            said.is_known ? "not GPI n or XPT D:S as RossTalk has it"
                                          : "no command that is taken");
            if (said.is_known)
                refuse_input("RossTalk", std::as_bytes(std::span(line)), sentence);
            else
                refuse(&PortStats::unknown, sentence);
            return;
        }
        const CommandCall* call = map_.find(*said.order);
        if (!call) {
            refuse(&PortStats::unknown, fmt::format("'{}' is mapped to nothing", printable(line)));
            return;
        }
        ++(intake_.take(*call, now) ? stats_.obeyed : stats_.dropped);
    }

    CommandIntake intake_;
    RossTalkMap map_;
    TcpListener listener_;
    std::map<int, LineSplitter> lines_;
    std::uint64_t seen_turned_away_ = 0;
};

}  // namespace

PortEntry rosstalk_port_entry() {
    return {"rosstalk", "rosstalk://HOST[:PORT] (GPI n, XPT D:S over TCP; ?map=FILE, open=yes)",
            [](const OutputUrl& url, const ControlBench& bench) {
                return std::make_unique<RossTalkPort>(url, bench);
            }};
}

}  // namespace vantage
