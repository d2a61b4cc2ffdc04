#include <map>
#include <thread>

#include <fmt/format.h>

#include "host_app/control/ports/control_port.h"
#include "host_app/control/ports/messages/tsl_message.h"
#include "host_app/control/ports/sockets.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t most_peers = 8;
constexpr int most_messages_a_look = 256, most_address = 65534, most_tally = 4;
/// Pause in a flood: TCP slows the sender down, the kernel drops datagrams, and rendering keeps the
/// processor.
constexpr auto flood_pause = 10ms;

class TslPort : public ControlPort {
  protected:
    TslPort(const OutputUrl& url, const ControlBench& bench) : bench_(bench) {
        url.require_options_of({"open", "over", "address", "programme", "preview"});
        address_ = url.number("address", 0, most_address).value_or(0);
        programme_ = url.number("programme", 1, most_tally).value_or(1);
        preview_ = url.number("preview", 1, most_tally).value_or(2);
    }

    void take(std::span<const std::byte> bytes) {
        const std::optional<std::vector<TslDisplay>> displays = decode_tsl(bytes);
        if (!displays) {
            refuse_input("TSL", bytes,
                         fmt::format("{} bytes that are no TSL UMD 3.1, 4.0 or 5.0", bytes.size()));
            return;
        }
        // Vision mixers send the state of every display to every display; messages for others are
        // valid.
        ++stats_.obeyed;
        const auto is_on = [](const TslDisplay& display, int tally) {
            return (display.tallies >> (tally - 1) & 1) != 0;
        };
        for (const TslDisplay& display : *displays)
            if (display.address == address_ || display.address == every_tsl_display)
                bench_.tally.put({is_on(display, programme_), is_on(display, preview_)});
    }

  private:
    ControlBench bench_;
    int address_ = 0, programme_ = 1, preview_ = 2;
};

class TslDatagrams final : public TslPort {
  public:
    TslDatagrams(const OutputUrl& url, const ControlBench& bench)
        : TslPort(url, bench),
          socket_(UdpSocket::bound(listening_place_of(url), "control " + url.shown)) {}

    void serve(std::chrono::milliseconds most) override {
        std::optional<UdpSocket::Datagram> datagram = socket_.receive(most);
        int looked_at = 0;
        for (; datagram && looked_at < most_messages_a_look; ++looked_at) {
            take(datagram->bytes);
            datagram = socket_.receive(0ms);
        }
        if (looked_at == most_messages_a_look) std::this_thread::sleep_for(flood_pause);
        stats_.dropped += socket_.overrun() - seen_overrun_;
        seen_overrun_ = socket_.overrun();
    }

  private:
    UdpSocket socket_;
    std::uint64_t seen_overrun_ = 0;
};

class TslConnections final : public TslPort {
  public:
    TslConnections(const OutputUrl& url, const ControlBench& bench)
        : TslPort(url, bench),
          listener_(listening_place_of(url), "control " + url.shown, most_peers) {}

    void serve(std::chrono::milliseconds most) override {
        std::size_t messages = 0;
        for (const TcpListener::Arrived& arrived : listener_.receive(most)) {
            if (arrived.bytes.empty()) {
                if (streams_[arrived.peer].has_rest())
                    refuse(&PortStats::malformed,
                           "part of a message, before the connection was closed");
                streams_.erase(arrived.peer);
                continue;
            }
            TslStream& stream = streams_[arrived.peer];
            const std::uint64_t strays = stream.strays();
            for (const std::string& message : stream.take(arrived.bytes)) {
                take(std::as_bytes(std::span(message)));
                ++messages;
            }
            for (std::uint64_t i = strays; i < stream.strays(); ++i)
                refuse(&PortStats::malformed, "bytes that are no message of TSL UMD 5.0 or 3.1");
        }
        stats_.dropped += listener_.turned_away() - seen_turned_away_;
        seen_turned_away_ = listener_.turned_away();
        if (messages >= most_messages_a_look) std::this_thread::sleep_for(flood_pause);
    }

  private:
    TcpListener listener_;
    std::map<int, TslStream> streams_;  ///< by connection
    std::uint64_t seen_turned_away_ = 0;
};

}  // namespace

PortEntry tsl_port_entry() {
    return {"tsl",
            "tsl://HOST:PORT (tally, TSL UMD 3.1 and 5.0; ?over=tcp for 5.0 over TCP, address=0, "
            "programme=1, preview=2, open=yes)",
            [](const OutputUrl& url, const ControlBench& bench) -> std::unique_ptr<ControlPort> {
                if (url.choice("over", {"udp", "tcp"}) == "tcp")
                    return std::make_unique<TslConnections>(url, bench);
                return std::make_unique<TslDatagrams>(url, bench);
            }};
}

}  // namespace vantage
