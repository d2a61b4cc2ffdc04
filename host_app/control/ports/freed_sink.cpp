#include "host_app/control/ports/freed_sink.h"

#include "host_app/control/freed/freed_message.h"
#include "host_app/control/ports/camera_pacer.h"
#include "host_app/control/ports/udp_socket.h"

namespace vantage {
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

}  // namespace

bool is_freed_url(const std::string& url) { return url.starts_with("freed:"); }

std::unique_ptr<PictureSink> make_freed_sink(const std::string& url, double rate_hz) {
    return std::make_unique<FreedSink>(OutputUrl::parse(url), rate_hz);
}

}  // namespace vantage
