#include <thread>

#include <fmt/format.h>

#include "host_app/control/ports/control_port.h"
#include "host_app/control/ports/tsl_message.h"
#include "host_app/control/ports/udp_socket.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr int most_datagrams_a_look = 256, most_address = 65534, most_tally = 4;

class TslPort final : public ControlPort {
  public:
    TslPort(const OutputUrl& url, const ControlBench& bench)
        : bench_(bench),
          socket_(UdpSocket::bound(listening_place_of(url), "control " + url.shown)) {
        url.require_options_of({"open", "address", "programme", "preview"});
        address_ = url.number("address", 0, most_address).value_or(0);
        programme_ = url.number("programme", 1, most_tally).value_or(1);
        preview_ = url.number("preview", 1, most_tally).value_or(2);
    }

    void serve(std::chrono::milliseconds most) override {
        std::optional<UdpSocket::Datagram> datagram = socket_.receive(most);
        int looked_at = 0;
        for (; datagram && looked_at < most_datagrams_a_look; ++looked_at) {
            take(datagram->bytes);
            datagram = socket_.receive(0ms);
        }
        if (looked_at == most_datagrams_a_look) std::this_thread::sleep_for(10ms);
        books_.dropped += socket_.overrun() - seen_overrun_;
        seen_overrun_ = socket_.overrun();
    }

  private:
    void take(std::span<const std::byte> bytes) {
        const std::optional<std::vector<TslDisplay>> displays = decode_tsl(bytes);
        if (!displays) {
            refuse(&PortBooks::malformed,
                   fmt::format("{} bytes that are no TSL UMD 3.1 or 5.0", bytes.size()));
            return;
        }
        // Mixers tell every display about every other; that is no fault.
        ++books_.obeyed;
        const auto is_on = [](const TslDisplay& display, int tally) {
            return (display.tallies >> (tally - 1) & 1) != 0;
        };
        for (const TslDisplay& display : *displays)
            if (display.address == address_)
                bench_.tally.put({is_on(display, programme_), is_on(display, preview_)});
    }

    ControlBench bench_;
    UdpSocket socket_;
    int address_ = 0, programme_ = 1, preview_ = 2;
    std::uint64_t seen_overrun_ = 0;
};

}  // namespace

PortEntry tsl_port_entry() {
    return {"tsl",
            "tsl://HOST:PORT (tally, TSL UMD 3.1 and 5.0; ?address=0, programme=1, preview=2, "
            "open=yes)",
            [](const OutputUrl& url, const ControlBench& bench) {
                return std::make_unique<TslPort>(url, bench);
            }};
}

}  // namespace vantage
