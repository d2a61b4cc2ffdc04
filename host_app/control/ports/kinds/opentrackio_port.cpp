#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/control/ports/control_port.h"
#include "host_app/control/ports/sockets.h"
#include "host_app/control/ports/tracking_sinks.h"
#include "host_app/control/tracking/opentrackio_sample.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr int most_packets_per_turn = 256;
constexpr int least_angle_deg = 5, most_angle_deg = 115;
/// Focus distance in metres for samples that contain none.
constexpr double default_focus_m = 4.5;
constexpr std::size_t most_sources = 64;

class OpentrackioPort final : public ControlPort {
  public:
    OpentrackioPort(const OutputUrl& url, const ControlBench& bench)
        : name_(url.shown),
          bench_(bench),
          socket_(UdpSocket::bound(listening_place_of(with_opentrackio_group(url)),
                                   "control " + url.shown)) {
        url.require_options_of({"open", "source", "fov", "sensor-mm"});
        source_ = url.number("source", 1, most_opentrackio_source);
        if (const auto angle_deg = url.number("fov", least_angle_deg, most_angle_deg))
            field_of_view_rad_ = *angle_deg * std::numbers::pi / 180;
        if (const auto width_mm = url.number("sensor-mm", least_sensor_mm, most_sensor_mm))
            sensor_width_mm_ = *width_mm;
    }

    void serve(std::chrono::milliseconds most) override {
        std::optional<UdpSocket::Datagram> datagram = socket_.receive(most);
        int taken = 0;
        for (; datagram && taken < most_packets_per_turn; ++taken) {
            take(*datagram);
            datagram = socket_.receive(0ms);
        }
        if (taken == most_packets_per_turn) std::this_thread::sleep_for(10ms);
        stats_.dropped += socket_.overrun() - seen_overrun_;
        seen_overrun_ = socket_.overrun();
    }

  private:
    void take(const UdpSocket::Datagram& datagram) {
        const OpentrackioReading reading = read_opentrackio_packet(datagram.bytes);
        if (!reading.packet) {
            refuse_input("OpenTrackIO", datagram.bytes, reading.fault);
            return;
        }
        std::string fault;
        const std::string sender = datagram.from.text();
        const auto sample = assembler_.add(sender, *reading.packet, fault);
        if (!fault.empty()) refuse_input("OpenTrackIO", datagram.bytes, fault);
        if (!sample) return;
        const OpentrackioCameraReading read =
            read_opentrackio_sample(sample->bytes, sample->encoding);
        if (!read.camera) {
            refuse_input("OpenTrackIO", sample->bytes, read.fault);
            return;
        }
        take_camera(sender, *read.camera);
    }

    void take_camera(const std::string& sender, const OpentrackioCamera& camera) {
        if (source_ && camera.source && *camera.source != static_cast<std::uint32_t>(*source_)) {
            refuse(&PortStats::unknown,
                   fmt::format("source {} where {} flies", *camera.source, *source_));
            return;
        }
        // Senders tell their sensor now and then only.
        const std::string key = fmt::format("{} {}", sender, camera.source.value_or(0));
        if (camera.sensor_width_mm &&
            (sensors_mm_.size() < most_sources || sensors_mm_.contains(key)))
            sensors_mm_[key] = *camera.sensor_width_mm;
        const std::optional<double> angle_rad = field_of_view_of(key, camera);
        if (!angle_rad) return;
        bench_.tracked.put(
            {camera.world_from_camera, *angle_rad, camera.focus_m.value_or(default_focus_m)},
            MonotonicClock::now());
        ++stats_.obeyed;
        tell_first(key, camera, *angle_rad);
    }

    /// Empty, and refused, if the sample does not give one.
    std::optional<double> field_of_view_of(const std::string& key,
                                           const OpentrackioCamera& camera) {
        if (field_of_view_rad_) return field_of_view_rad_;
        std::optional<double> width_mm = sensor_width_mm_;
        if (const auto known = sensors_mm_.find(key); !width_mm && known != sensors_mm_.end())
            width_mm = known->second;
        if (!camera.focal_length_mm || !width_mm) {
            refuse(&PortStats::malformed,
                   fmt::format("an OpenTrackIO sample without {}; say fov=DEGREES{}",
                               camera.focal_length_mm ? "the width of the sensor until now"
                                                      : "a pinhole focal length",
                               camera.focal_length_mm ? " or sensor-mm=WIDTH" : ""));
            return std::nullopt;
        }
        const double angle_rad = 2 * std::atan(*width_mm / 2 / *camera.focal_length_mm);
        const FlightLimits limits;
        if (angle_rad >= limits.min_field_of_view_rad && angle_rad <= limits.max_field_of_view_rad)
            return angle_rad;
        refuse(&PortStats::malformed,
               fmt::format("a focal length of {:g} mm on a sensor of {:g} mm, which is a field of "
                           "view of {:.1f} degrees; it has to be 5 to 115",
                           *camera.focal_length_mm, *width_mm, angle_rad * 180 / std::numbers::pi));
        return std::nullopt;
    }

    /// Logs each source once.
    void tell_first(const std::string& key, const OpentrackioCamera& camera, double angle_rad) {
        if (told_.size() >= most_sources || !told_.insert(key).second) return;
        stats_.told = fmt::format("source {}: a field of view of {:.1f} degrees",
                                  camera.source.value_or(0), angle_rad * 180 / std::numbers::pi);
        log_info("control {}: {}", name_, stats_.told);
    }

    std::string name_;
    ControlBench bench_;
    UdpSocket socket_;
    OpentrackioAssembler assembler_;
    std::map<std::string, double> sensors_mm_;
    std::set<std::string> told_;
    std::optional<int> source_;
    std::optional<double> field_of_view_rad_, sensor_width_mm_;
    std::uint64_t seen_overrun_ = 0;
};

}  // namespace

PortEntry opentrackio_port_entry() {
    return {"opentrackio",
            "opentrackio://HOST:PORT or opentrackio://multicast (a tracked camera flies; "
            "?source=1, fov=40, sensor-mm=36, open=yes)",
            [](const OutputUrl& url, const ControlBench& bench) {
                return std::make_unique<OpentrackioPort>(url, bench);
            }};
}

}  // namespace vantage
