#include "host_app/control/ports/freed_sink.h"

#include "host_app/control/freed/freed_message.h"
#include "host_app/control/ports/udp_socket.h"

namespace vantage {
namespace {

constexpr int most_camera_id = 255;

class FreedSink final : public PictureSink {
  public:
    explicit FreedSink(const OutputUrl& url)
        : name_(url.shown),
          to_(resolve(network_place_of(url), "output " + url.shown)),
          socket_(UdpSocket::sending(to_)) {
        url.require_options_of({"camera"});
        id_ = static_cast<std::uint8_t>(url.number("camera", 0, most_camera_id).value_or(1));
    }
    std::string name() const override { return name_; }
    void take(const ProgrammePicture& picture) override {
        // UDP has no receipt: a missing receiver is not an error.
        (void)socket_.send(encode_freed(freed_camera(picture.camera, id_)), to_);
    }

  private:
    std::string name_;
    SocketAddress to_;
    UdpSocket socket_;
    std::uint8_t id_ = 1;
};

}  // namespace

bool is_freed_url(const std::string& url) { return url.starts_with("freed:"); }

std::unique_ptr<PictureSink> make_freed_sink(const std::string& url) {
    return std::make_unique<FreedSink>(OutputUrl::parse(url));
}

}  // namespace vantage
