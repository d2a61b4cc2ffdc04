#include <numbers>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/control/ports/control_port.h"
#include "host_app/control/ports/sockets.h"
#include "host_app/control/tracking/freed_message.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr int most_datagrams_a_look = 256;
constexpr int most_camera_id = 255, least_angle_deg = 5, most_angle_deg = 115;
/// Focus distance in metres for messages that contain none.
constexpr double usual_focus_m = 4.5;

class FreedPort final : public ControlPort {
  public:
    FreedPort(const OutputUrl& url, const ControlBench& bench)
        : name_(url.shown),
          bench_(bench),
          socket_(UdpSocket::bound(listening_place_of(url), "control " + url.shown)) {
        url.require_options_of({"open", "camera", "fov"});
        camera_ = url.number("camera", 0, most_camera_id);
        if (const auto angle_deg = url.number("fov", least_angle_deg, most_angle_deg))
            field_of_view_rad_ = *angle_deg * std::numbers::pi / 180;
    }

    void serve(std::chrono::milliseconds most) override {
        std::optional<UdpSocket::Datagram> datagram = socket_.receive(most);
        int looked_at = 0;
        for (; datagram && looked_at < most_datagrams_a_look; ++looked_at) {
            take(datagram->bytes);
            datagram = socket_.receive(0ms);
        }
        if (looked_at == most_datagrams_a_look) std::this_thread::sleep_for(10ms);
        stats_.dropped += socket_.overrun() - seen_overrun_;
        seen_overrun_ = socket_.overrun();
    }

  private:
    /// A datagram may contain several messages, one after another.
    void take(std::span<const std::byte> bytes) {
        const bool are_several = !bytes.empty() && bytes.size() % freed_bytes == 0;
        if (!are_several) return take_message(bytes);
        for (; !bytes.empty(); bytes = bytes.subspan(freed_bytes))
            take_message(bytes.first(freed_bytes));
    }

    void take_message(std::span<const std::byte> bytes) {
        const FreedReading reading = read_freed(bytes);
        const std::optional<FreedCamera>& message = reading.camera;
        if (!message) {
            refuse_input("FreeD", bytes, reading.fault);
            return;
        }
        if (camera_ && message->id != *camera_) {
            refuse(&PortStats::unknown,
                   fmt::format("camera {} where {} flies", message->id, *camera_));
            return;
        }
        const std::optional<double> angle_rad =
            field_of_view_rad_ ? field_of_view_rad_ : freed_field_of_view_rad(*message);
        if (!angle_rad) {
            refuse(&PortStats::malformed,
                   fmt::format("a zoom of {}, which is no field of view of 5000 to 115000 "
                               "thousandths of a degree; say fov=DEGREES",
                               message->zoom));
            return;
        }
        tell_first(*message, *angle_rad);
        constexpr double mm = 1000;
        bench_.tracked.put(
            {message->world_from_camera, *angle_rad,
             message->focus > 0 && !field_of_view_rad_ ? message->focus / mm : usual_focus_m},
            MonotonicClock::now());
        ++stats_.obeyed;
    }

    /// Logs once for each camera which lens is assumed, since the protocol does not transmit it.
    void tell_first(const FreedCamera& message, double angle_rad) {
        if (!told_cameras_.insert(message.id).second) return;
        const double angle_deg = angle_rad * 180 / std::numbers::pi;
        const std::string guess =
            field_of_view_rad_
                ? fmt::format("its field of view is {:g} degrees, as fov= says", angle_deg)
                : fmt::format(
                      "its zoom {} is taken as a field of view of {:g} degrees and its "
                      "focus {} as millimetres; if they are a focal length or an "
                      "encoder's count, say fov=DEGREES",
                      message.zoom, angle_deg, message.focus);
        stats_.told = fmt::format("camera {}: {}", message.id, guess);
        log_info("control {}: camera {} is heard; {}", name_, message.id, guess);
    }

    std::string name_;
    ControlBench bench_;
    UdpSocket socket_;
    std::set<int> told_cameras_;
    std::optional<int> camera_;
    std::optional<double> field_of_view_rad_;
    std::uint64_t seen_overrun_ = 0;
};

}  // namespace

PortEntry freed_port_entry() {
    return {"freed", "freed://HOST:PORT (a tracked camera flies; ?camera=1, fov=40, open=yes)",
            [](const OutputUrl& url, const ControlBench& bench) {
                return std::make_unique<FreedPort>(url, bench);
            }};
}

}  // namespace vantage
