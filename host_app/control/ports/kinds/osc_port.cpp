#include <charconv>
#include <cmath>
#include <map>
#include <thread>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/control/ports/control_port.h"
#include "host_app/control/ports/messages/osc_message.h"
#include "host_app/control/ports/sockets.h"
#include "host_app/control/table/control_command.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view root = "/vantage/";
constexpr int most_datagrams_a_look = 256;
constexpr std::size_t most_subscribers = 8;
constexpr std::chrono::seconds subscription{60}, all_again{2};
constexpr std::chrono::milliseconds lamp_period{40};

/// Address that receives the lamps, and the end of its subscription.
struct Listener {
    SocketAddress address;
    std::optional<MonotonicTime> until;  ///< empty: until the port closes
};

class OscPort final : public ControlPort {
  public:
    OscPort(const OutputUrl& url, const ControlBench& bench)
        : bench_(bench),
          intake_(bench.operator_input),
          socket_(UdpSocket::bound(listening_place_of(url), "control " + url.shown)) {
        url.require_options_of({"open", "lamps"});
        if (const std::optional<std::string> to = url.option("lamps")) {
            OutputUrl place = url;
            place.place = *to;
            listeners_.push_back({resolve(network_place_of(place), "control " + url.shown), {}});
        }
    }

    void serve(std::chrono::milliseconds most) override {
        std::optional<UdpSocket::Datagram> datagram = socket_.receive(std::min(most, lamp_period));
        int looked_at = 0;
        for (; datagram && looked_at < most_datagrams_a_look; ++looked_at) {
            take(*datagram);
            datagram = socket_.receive(0ms);
        }
        // In a flood the port pauses, so that the kernel drops the rest and rendering keeps the
        // processor.
        if (looked_at == most_datagrams_a_look) std::this_thread::sleep_for(10ms);
        stats_.dropped += socket_.overrun() - seen_overrun_;
        seen_overrun_ = socket_.overrun();
        tell(MonotonicClock::now());
    }

  private:
    void take(const UdpSocket::Datagram& datagram) {
        const MonotonicTime now = MonotonicClock::now();
        const std::optional<std::vector<OscMessage>> messages = decode_osc(datagram.bytes);
        if (!messages) {
            refuse_input("OSC", datagram.bytes,
                         fmt::format("{} bytes that are no OSC", datagram.bytes.size()));
            return;
        }
        for (const OscMessage& message : *messages) obey(message, datagram.from, now);
    }

    void obey(const OscMessage& message, const SocketAddress& from, MonotonicTime now) {
        if (!message.address.starts_with(root)) {
            refuse(&PortStats::unknown,
                   fmt::format("{} does not begin with {}", printable(message.address), root));
            return;
        }
        std::string name = message.address.substr(root.size());
        if (name == "subscribe") {
            subscribe(message, from, now);
            return;
        }
        std::vector<double> numbers = message.numbers;
        // "/vantage/shot/3" is a separate button on a control surface.
        if (const std::size_t slash = name.find('/'); slash != std::string::npos) {
            int number = 0;
            const char* last = name.data() + name.size();
            const auto [end, error] = std::from_chars(name.data() + slash + 1, last, number);
            if (error == std::errc() && end == last) {
                numbers.insert(numbers.begin(), number);
                name.resize(slash);
            }
        }
        const ControlCommand* command = find_command(name);
        if (!command) {
            refuse(&PortStats::unknown,
                   fmt::format("{} is no command", printable(message.address)));
            return;
        }
        const bool has_words = command->argument == CommandArgument::words;
        const std::size_t needed = command->argument == CommandArgument::none || has_words ? 0 : 1;
        // A button of a control surface sends 1 when pressed and 0 when released.
        const bool has_press = numbers.size() == needed + 1 && !has_words &&
                               command->argument != CommandArgument::steps;
        const bool is_let_go = has_press && numbers.back() == 0;
        if (has_press) numbers.pop_back();
        std::optional<CommandCall> call;
        if (numbers.size() == needed && message.words.size() == (has_words ? 1 : 0) &&
            !message.has_others) {
            if (has_words)
                call = call_of(*command, message.words.front());
            else
                call = call_of(*command, needed ? std::optional(numbers.front()) : std::nullopt);
        }
        if (!call) {
            refuse(&PortStats::malformed,
                   fmt::format("{} has arguments that do not fit", printable(message.address)));
            return;
        }
        ++(is_let_go || intake_.take(*call, now) ? stats_.obeyed : stats_.dropped);
    }

    void subscribe(const OscMessage& message, const SocketAddress& from, MonotonicTime now) {
        constexpr double highest_port = 65535;
        SocketAddress to = from;
        if (!message.numbers.empty()) {
            const double port = message.numbers.front();
            if (!(port >= 1 && port <= highest_port && port == std::floor(port))) {
                refuse(&PortStats::malformed, "/vantage/subscribe takes a port, 1 to 65535");
                return;
            }
            to = from.with_port(static_cast<std::uint16_t>(port));
        }
        std::erase_if(listeners_, [&](const Listener& listener) {
            return listener.until && (*listener.until < now || listener.address == to);
        });
        if (listeners_.size() >= most_subscribers) {
            ++stats_.dropped;
            return;
        }
        listeners_.push_back({to, now + subscription});
        ++stats_.obeyed;
        is_all_due_ = true;
    }

    /// Sends lamps that changed, and all of them every other second, since a datagram may be lost.
    void tell(MonotonicTime now) {
        if (listeners_.empty() || (now - told_ < lamp_period && !is_all_due_)) return;
        told_ = now;
        std::erase_if(listeners_, [&](const Listener& listener) {
            return listener.until && *listener.until < now;
        });
        const bool is_all = is_all_due_ || now - told_all_ >= all_again;
        if (is_all) told_all_ = now;
        is_all_due_ = false;
        const ShowLamps shown = bench_.lamps.state();
        for (const Lamp& lamp : lamps()) {
            const LampValue value = lamp.of(shown);
            LampValue& last = last_values_[lamp.name];
            if (!is_all && value == last) continue;
            last = value;
            for (const std::string_view name : {lamp.name, lamp.old_name}) {
                if (name.empty()) continue;
                const std::vector<std::byte> bytes =
                    encode_osc(fmt::format("{}lamp/{}", root, name), value);
                for (const Listener& listener : listeners_)
                    (void)socket_.send(bytes, listener.address);
            }
        }
    }

    ControlBench bench_;
    CommandIntake intake_;
    UdpSocket socket_;
    std::vector<Listener> listeners_;
    std::map<std::string, LampValue> last_values_;
    MonotonicTime told_{}, told_all_{};
    bool is_all_due_ = true;
    std::uint64_t seen_overrun_ = 0;
};

}  // namespace

PortEntry osc_port_entry() {
    return {"osc", "osc://HOST:PORT (commands /vantage/NAME; ?lamps=HOST:PORT, open=yes)",
            [](const OutputUrl& url, const ControlBench& bench) {
                return std::make_unique<OscPort>(url, bench);
            }};
}

}  // namespace vantage
