// A USB camera in software: speaks the usbredir protocol with QEMU, whose guest sees a USB Video
// Class device with the kernel's own drivers.
//   usb_camera SOCKET SERIAL WIDTH HEIGHT RATE_HZ PICTURE
// Shows the picture until QEMU goes away; ending it unplugs the camera.
#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <memory>
#include <string>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <usbredirparser.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "tests/hil/usb_camera/uvc_descriptors.h"
#include "tests/hil/usb_camera/yuyv_picture.h"

namespace vantage::usb {
namespace {

using Clock = std::chrono::steady_clock;

class UsbCamera {
  public:
    UsbCamera(UniqueFd connection, std::string serial, const CameraMode& mode,
              const cv::Mat2b& picture)
        : connection_(std::move(connection)),
          serial_(std::move(serial)),
          mode_(mode),
          picture_(picture.ptr<std::uint8_t>(), picture.ptr<std::uint8_t>() + mode.frame_bytes()),
          parser_(usbredirparser_create(), usbredirparser_destroy) {
        usbredirparser& p = *parser_;
        p.priv = this;
        p.log_func = [](void*, int level, const char* text) {
            if (level <= usbredirparser_warning) std::fprintf(stderr, "usb_camera: %s\n", text);
        };
        p.read_func = [](void* self, std::uint8_t* data, int size) {
            return me(self).read(data, size);
        };
        p.write_func = [](void* self, std::uint8_t* data, int size) {
            return me(self).write(data, size);
        };
        p.hello_func = [](void* self, usb_redir_hello_header*) { me(self).connect(); };
        p.reset_func = [](void* self) { me(self).waiting_.clear(); };
        p.set_configuration_func = [](void* self, std::uint64_t id,
                                      usb_redir_set_configuration_header* h) {
            me(self).announce_endpoints();
            usb_redir_configuration_status_header status{usb_redir_success, h->configuration};
            usbredirparser_send_configuration_status(me(self).parser_.get(), id, &status);
        };
        p.get_configuration_func = [](void* self, std::uint64_t id) {
            usb_redir_configuration_status_header status{usb_redir_success, 1};
            usbredirparser_send_configuration_status(me(self).parser_.get(), id, &status);
        };
        p.set_alt_setting_func = [](void* self, std::uint64_t id,
                                    usb_redir_set_alt_setting_header* h) {
            usb_redir_alt_setting_status_header status{usb_redir_success, h->interface, h->alt};
            usbredirparser_send_alt_setting_status(me(self).parser_.get(), id, &status);
        };
        p.get_alt_setting_func = [](void* self, std::uint64_t id,
                                    usb_redir_get_alt_setting_header* h) {
            usb_redir_alt_setting_status_header status{usb_redir_success, h->interface, 0};
            usbredirparser_send_alt_setting_status(me(self).parser_.get(), id, &status);
        };
        p.cancel_data_packet_func = [](void* self, std::uint64_t id) { me(self).cancel(id); };
        p.control_packet_func = [](void* self, std::uint64_t id,
                                   usb_redir_control_packet_header* header, std::uint8_t* data,
                                   int) {
            // What is left of a frame that it was unplugged in is of no use.
            if (commits_stream(*header)) me(self).sending_ = false;
            me(self).control(id, *header);
            if (data) usbredirparser_free_packet_data(me(self).parser_.get(), data);
        };
        p.bulk_packet_func = [](void* self, std::uint64_t id, usb_redir_bulk_packet_header* header,
                                std::uint8_t* data, int) {
            if (data) usbredirparser_free_packet_data(me(self).parser_.get(), data);
            me(self).waiting_.push_back(
                {id, static_cast<std::uint32_t>(header->length) |
                         static_cast<std::uint32_t>(header->length_high) << 16});
        };
        std::array<std::uint32_t, USB_REDIR_CAPS_SIZE> caps{};
        usbredirparser_caps_set_cap(caps.data(), usb_redir_cap_connect_device_version);
        usbredirparser_caps_set_cap(caps.data(), usb_redir_cap_ep_info_max_packet_size);
        usbredirparser_caps_set_cap(caps.data(), usb_redir_cap_64bits_ids);
        usbredirparser_caps_set_cap(caps.data(), usb_redir_cap_32bits_bulk_length);
        usbredirparser_init(&p, "vantage usb_camera", caps.data(), USB_REDIR_CAPS_SIZE,
                            usbredirparser_fl_usb_host);
    }

    void run() {
        while (!gone_) {
            if (usbredirparser_has_data_to_write(parser_.get()))
                usbredirparser_do_write(parser_.get());
            const int wait_ms = send_frame();
            pollfd wait{.fd = connection_.get(), .events = POLLIN, .revents = 0};
            if (::poll(&wait, 1, wait_ms) > 0) usbredirparser_do_read(parser_.get());
        }
    }

  private:
    struct Transfer {
        std::uint64_t id;
        std::uint32_t bytes;
    };

    static UsbCamera& me(void* self) { return *static_cast<UsbCamera*>(self); }

    int read(std::uint8_t* data, int size) {
        const ssize_t got =
            ::recv(connection_.get(), data, static_cast<std::size_t>(size), MSG_DONTWAIT);
        if (got < 0 && errno == EAGAIN) return 0;
        if (got <= 0) gone_ = true;
        return gone_ ? -1 : static_cast<int>(got);
    }
    int write(const std::uint8_t* data, int size) {
        const ssize_t put =
            ::send(connection_.get(), data, static_cast<std::size_t>(size), MSG_NOSIGNAL);
        if (put < 0) gone_ = true;
        return static_cast<int>(put);
    }

    void announce_endpoints() const {
        usb_redir_ep_info_header endpoints{};
        std::fill(std::begin(endpoints.type), std::end(endpoints.type), usb_redir_type_invalid);
        constexpr std::size_t control_in = 16, bulk_in = 17;  // of the endpoints' table
        endpoints.type[0] = endpoints.type[control_in] = usb_redir_type_control;
        endpoints.max_packet_size[0] = endpoints.max_packet_size[control_in] = 64;
        endpoints.type[bulk_in] = usb_redir_type_bulk;
        endpoints.max_packet_size[bulk_in] = packet_bytes;
        endpoints.interface[bulk_in] = 1;
        usb_redir_interface_info_header interfaces{};
        interfaces.interface_count = 2;
        interfaces.interface[1] = 1;
        interfaces.interface_class[0] = interfaces.interface_class[1] = 0x0e;
        interfaces.interface_subclass[0] = 1;
        interfaces.interface_subclass[1] = 2;
        usbredirparser_send_interface_info(parser_.get(), &interfaces);
        usbredirparser_send_ep_info(parser_.get(), &endpoints);
    }

    void connect() const {
        announce_endpoints();
        usb_redir_device_connect_header device{};
        device.speed = usb_redir_speed_high;
        device.device_class = 0xef;
        device.device_subclass = 2;
        device.device_protocol = 1;
        device.vendor_id = vendor_id;
        device.product_id = product_id;
        device.device_version_bcd = 0x100;
        usbredirparser_send_device_connect(parser_.get(), &device);
    }

    void cancel(std::uint64_t id) {
        const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                        [&](const Transfer& t) { return t.id == id; });
        if (found == waiting_.end()) return;
        waiting_.erase(found);
        usb_redir_bulk_packet_header answer{};
        answer.endpoint = stream_endpoint;
        answer.status = usb_redir_cancelled;
        usbredirparser_send_bulk_packet(parser_.get(), id, &answer, nullptr, 0);
    }

    /// Whether the guest is about to stream.
    static bool commits_stream(const usb_redir_control_packet_header& request) {
        constexpr int set_current = 0x01, class_to_interface = 0x21, commit_control = 2;
        return request.requesttype == class_to_interface && request.request == set_current &&
               request.value >> 8 == commit_control;
    }

    void control(std::uint64_t id, const usb_redir_control_packet_header& header) const {
        bool known = true;
        Bytes data = answer_to(header, known);
        usb_redir_control_packet_header answer = header;
        answer.status = known ? usb_redir_success : usb_redir_stall;
        if (!known) answer.length = 0;
        const bool to_host = (header.requesttype & 0x80) != 0;
        if (!known || !to_host) {
            usbredirparser_send_control_packet(parser_.get(), id, &answer, nullptr, 0);
            return;
        }
        if (data.size() > header.length) data.resize(header.length);
        answer.length = static_cast<std::uint16_t>(data.size());
        usbredirparser_send_control_packet(parser_.get(), id, &answer, data.data(),
                                           static_cast<int>(data.size()));
    }

    Bytes answer_to(const usb_redir_control_packet_header& request, bool& known) const {
        constexpr std::uint8_t get_status = 0, get_descriptor = 6, standard_in = 0x80,
                               endpoint_in = 0x82;
        constexpr std::uint8_t get_length = 0x85, get_info = 0x86;
        const int selector = request.value >> 8;
        if (request.requesttype == standard_in && request.request == get_descriptor) {
            if (selector == 1) return device_descriptor();
            if (selector == 2) return configuration_descriptor(mode_);
            if (selector == 3) return string_descriptor(request.value & 0xff, serial_);
            known = false;
            return {};
        }
        if ((request.requesttype == standard_in || request.requesttype == endpoint_in) &&
            request.request == get_status)
            return {0, 0};
        const bool is_class_request = (request.requesttype & 0x60) == 0x20;
        if (!is_class_request) return {};
        const bool of_streaming = (request.index & 0xff) == 1;
        known = of_streaming;
        if (!of_streaming) return {};
        if (request.request == get_info) return {3};
        if (request.request == get_length) return {26, 0};
        return probe_control(mode_);
    }

    /// Sends what is due of a frame; how long to wait for the next, -1: until the guest asks.
    int send_frame() {
        if (waiting_.empty()) return -1;
        const Clock::time_point now = Clock::now();
        if (!sending_) {
            const auto period = std::chrono::nanoseconds(std::chrono::seconds(1)) / mode_.rate_hz;
            if (next_ + 5 * period < now) next_ = now;
            if (now < next_)
                return static_cast<int>(
                    std::chrono::ceil<std::chrono::milliseconds>(next_ - now).count());
            next_ += period;
            constexpr std::uint8_t end_of_header = 0x80, end_of_frame = 0x02;
            frame_ = {payload_header_bytes,
                      static_cast<std::uint8_t>(end_of_header | end_of_frame | (toggle_ ? 1 : 0))};
            append(frame_, picture_);
            toggle_ = !toggle_;
            sent_ = 0;
            sending_ = true;
        }
        const Transfer transfer = waiting_.front();
        waiting_.pop_front();
        const auto size = static_cast<std::uint32_t>(
            std::min<std::size_t>(transfer.bytes, frame_.size() - sent_));
        usb_redir_bulk_packet_header header{};
        header.endpoint = stream_endpoint;
        header.status = usb_redir_success;
        header.length = static_cast<std::uint16_t>(size & 0xffff);
        header.length_high = static_cast<std::uint16_t>(size >> 16);
        usbredirparser_send_bulk_packet(parser_.get(), transfer.id, &header, &frame_[sent_],
                                        static_cast<int>(size));
        sent_ += size;
        sending_ = sent_ < frame_.size();
        return 0;
    }

    UniqueFd connection_;
    std::string serial_;
    CameraMode mode_;
    Bytes picture_;
    std::unique_ptr<usbredirparser, decltype(&usbredirparser_destroy)> parser_;
    bool gone_ = false;
    std::deque<Transfer> waiting_;
    Bytes frame_;
    std::size_t sent_ = 0;
    bool sending_ = false, toggle_ = false;
    Clock::time_point next_ = Clock::now();
};

/// QEMU's connection to the socket.
UniqueFd accept_one(const std::string& path) {
    sockaddr_un address{};
    if (path.size() >= sizeof address.sun_path) fail("{} is too long for a socket", path);
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    ::unlink(path.c_str());
    const UniqueFd listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener.get(), 1) != 0)
        fail("{} cannot be listened on: {}", path, std::strerror(errno));
    constexpr int patience_ms = 60'000;
    pollfd wait{.fd = listener.get(), .events = POLLIN, .revents = 0};
    if (::poll(&wait, 1, patience_ms) <= 0) fail("nobody connected to {}", path);
    UniqueFd connection(::accept(listener.get(), nullptr, nullptr));
    ::unlink(path.c_str());
    return connection;
}

}  // namespace
}  // namespace vantage::usb

int main(int argc, char** argv) {
    try {
        if (argc != 7)
            vantage::fail("usage: usb_camera SOCKET SERIAL WIDTH HEIGHT RATE_HZ PICTURE");
        const vantage::usb::CameraMode mode{std::stoi(argv[3]), std::stoi(argv[4]),
                                            std::stoi(argv[5])};
        const cv::Mat2b picture =
            vantage::yuyv_picture(argv[6], cv::Size(mode.width_px, mode.height_px));
        vantage::usb::UsbCamera(vantage::usb::accept_one(argv[1]), argv[2], mode, picture).run();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "usb_camera: %s\n", error.what());
        return 1;
    }
    return 0;
}
