#include "host_app/control/ports/tracking_sinks.h"

#include <algorithm>
#include <chrono>

#include <poll.h>
#include <pthread.h>

#include "common/base/this_thread.h"
#include "common/wire/random_id.h"
#include "host_app/control/ports/sockets.h"
#include "host_app/control/tracking/freed_message.h"
#include "host_app/control/tracking/opentrackio_sample.h"
#include "host_app/output/picture_sink.h"

namespace vantage {
namespace {

/// Asks for real-time priority for this thread, below that of drivers.
void ask_for_realtime() {
    sched_param parameters{};
    parameters.sched_priority = 10;
    (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

}  // namespace

CameraTick camera_tick_of(const ProgrammePicture& picture) {
    return {.tick = picture.tick,
            .due = picture.due,
            .camera = picture.camera,
            .width_px = picture.picture.cols,
            .height_px = picture.picture.rows,
            .timecode = {},
            .ptp_locked = {}};
}

CameraPacer::CameraPacer(double rate_hz, std::function<void(const CameraTick&)> send)
    : rate_hz_(rate_hz), send_(std::move(send)), thread_([this] { run(); }) {}

CameraPacer::~CameraPacer() { stop(); }

void CameraPacer::take(const CameraTick& tick) {
    if (is_stopped_) return;
    handed_.give(tick);
    changed_.notify();
}

void CameraPacer::stop() {
    is_stopped_ = true;
    changed_.notify();
    if (thread_.joinable()) thread_.join();
}

/// Sends all ticks up to the newest one, which has passed since the last was sent.
void CameraPacer::send_until(const CameraTick& newest) {
    CameraTick tick = newest;
    for (; next_ <= newest.tick; ++next_) {
        tick.tick = next_;
        tick.due = newest.due - from_s(static_cast<double>(newest.tick - next_) / rate_hz_);
        send_(tick);
    }
}

MonotonicTime CameraPacer::due_of_next(const CameraTick& newest) const {
    return newest.due + from_s(static_cast<double>(next_ - newest.tick) / rate_hz_);
}

void CameraPacer::wait_until(std::optional<MonotonicTime> time) const {
    timespec timeout{};
    if (time) {
        const std::chrono::nanoseconds left =
            std::max(*time - MonotonicClock::now(), std::chrono::nanoseconds(0));
        const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
        timeout = {.tv_sec = seconds.count(), .tv_nsec = (left - seconds).count()};
    }
    pollfd event{.fd = changed_.fd(), .events = POLLIN, .revents = 0};
    (void)ppoll(&event, 1, time ? &timeout : nullptr, nullptr);
}

void CameraPacer::run() {
    name_this_thread("camera pacer");
    ask_for_realtime();
    constexpr double grace = 0.25;  // periods
    constexpr std::chrono::seconds longest_repetition{1};
    const std::chrono::nanoseconds patience = from_s(grace / rate_hz_);
    CameraTick newest;
    bool is_begun = false;
    for (;;) {
        changed_.clear();
        const bool is_last = is_stopped_;
        if (const CameraTick* handed = handed_.take()) {
            newest = *handed;
            is_begun = true;
            send_until(newest);
        }
        if (is_last) return;
        if (!is_begun || due_of_next(newest) - newest.due > longest_repetition) {
            wait_until(std::nullopt);
        } else if (const MonotonicTime latest = due_of_next(newest) + patience;
                   MonotonicClock::now() < latest) {
            wait_until(latest);
        } else {
            CameraTick repeated = newest;
            repeated.tick = next_;
            repeated.due = due_of_next(newest);
            send_until(repeated);
        }
    }
}

namespace {

constexpr int most_camera_id = 255;

class FreedSink final : public PictureSink {
  public:
    FreedSink(const OutputUrl& url, double rate_hz)
        : name_(url.shown),
          to_(resolve(network_place_of(url), "output " + url.shown)),
          socket_(UdpSocket::sending(to_)),
          pacer_(rate_hz, [this](const CameraTick& tick) { send(tick); }) {
        url.require_options_of({"camera"});
        id_ = static_cast<std::uint8_t>(url.number("camera", 0, most_camera_id).value_or(1));
    }
    std::string name() const override { return name_; }
    void take(const ProgrammePicture& picture) override { pacer_.take(camera_tick_of(picture)); }
    void finish() override { pacer_.stop(); }

  private:
    void send(const CameraTick& tick) {
        // UDP has no receipt: a missing receiver is not an error.
        (void)socket_.send(encode_freed(freed_camera(tick.camera, id_)), to_);
    }

    std::string name_;
    SocketAddress to_;
    UdpSocket socket_;
    std::uint8_t id_ = 1;
    CameraPacer pacer_;  ///< the last member: it uses the others until it has ended
};

/// Above this rate frames share numbers of time code.
constexpr double most_timecode_hz = 60;
/// Packets count from 1 to this number.
constexpr std::uint64_t most_sequence = 65535;

/// Whether all rigs of the frame set are disciplined by PTP; empty without rigs.
std::optional<bool> is_ptp_locked(const FrameSet& set) {
    std::optional<bool> locked;
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame) locked = locked.value_or(true) && slot.frame->sync.disciplined;
    return locked;
}

class OpentrackioSink final : public PictureSink {
  public:
    OpentrackioSink(const OutputUrl& url, double rate_hz, double pulse_rate_hz)
        : name_(url.shown),
          to_(resolve(network_place_of(with_opentrackio_group(url)), "output " + url.shown)),
          socket_(UdpSocket::sending(to_)),
          pacer_(rate_hz, [this](const CameraTick& tick) { send(tick); }) {
        url.require_options_of({"source", "format", "sensor-mm"});
        encoding_ = url.choice("format", {"json", "cbor"}) == "cbor" ? OpentrackioEncoding::cbor
                                                                     : OpentrackioEncoding::json;
        sample_.source = static_cast<std::uint32_t>(
            url.number("source", 1, most_opentrackio_source).value_or(1));
        sample_.sensor_width_mm =
            url.number("sensor-mm", least_sensor_mm, most_sensor_mm).value_or(usual_sensor_mm);
        sample_.rate = PulseGrid(rate_hz).rate();
        sample_.source_id = uuid_urn(base_, 0);
        if (rate_hz <= most_timecode_hz) timecode_.emplace(pulse_rate_hz, rate_hz);
    }
    std::string name() const override { return name_; }
    void take(const ProgrammePicture& picture) override {
        CameraTick tick = camera_tick_of(picture);
        if (picture.set) {
            if (timecode_) tick.timecode = SmpteCode::parse(timecode_->of(*picture.set));
            tick.ptp_locked = is_ptp_locked(*picture.set);
        }
        pacer_.take(tick);
    }
    void finish() override { pacer_.stop(); }

  private:
    void send(const CameraTick& tick) {
        sample_.camera = tick.camera;
        sample_.time = TaiClock::now();
        sample_.sequence = static_cast<std::uint32_t>(tick.tick);
        sample_.sample_id = uuid_urn(base_, tick.tick + 1);
        sample_.width_px = tick.width_px;
        sample_.height_px = tick.height_px;
        sample_.timecode = tick.timecode;
        sample_.ptp_locked = tick.ptp_locked;
        // UDP has no receipt: a missing receiver is not an error.
        for (const std::vector<std::byte>& packet :
             opentrackio_packets(write_opentrackio_sample(sample_, encoding_), encoding_,
                                 static_cast<std::uint16_t>(1 + tick.tick % most_sequence)))
            (void)socket_.send(packet, to_);
    }

    std::string name_;
    SocketAddress to_;
    UdpSocket socket_;
    const std::uint64_t base_ = random_id();
    OpentrackioEncoding encoding_ = OpentrackioEncoding::json;
    OpentrackioSample sample_;
    std::optional<SetTimecode> timecode_;
    CameraPacer pacer_;  ///< the last member: it uses the others until it has ended
};

}  // namespace

OutputUrl with_opentrackio_group(OutputUrl url) {
    if (url.place == "multicast")
        url.place = "239.135.1." +
                    std::to_string(url.number("source", 1, most_opentrackio_source).value_or(1)) +
                    ":55555";
    return url;
}

std::unique_ptr<PictureSink> make_tracking_sink(const std::string& url, double rate_hz,
                                                double pulse_rate_hz) {
    if (url.starts_with("freed:"))
        return std::make_unique<FreedSink>(OutputUrl::parse(url), rate_hz);
    if (url.starts_with("opentrackio:"))
        return std::make_unique<OpentrackioSink>(OutputUrl::parse(url), rate_hz, pulse_rate_hz);
    return nullptr;
}

}  // namespace vantage
