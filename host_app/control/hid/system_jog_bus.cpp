#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <cwchar>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <linux/input.h>
#include <poll.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "host_app/control/hid/jog_devices.h"

namespace vantage {
namespace {

/// Converts a device name to ASCII; other characters become '?'.
std::string narrow(const wchar_t* wide) {
    std::string text;
    for (; wide && *wide; ++wide)
        text += *wide >= 32 && *wide < 127 ? static_cast<char>(*wide) : '?';
    return text;
}

std::string described(const JogPlace& place) {
    return (place.name.empty() ? "the device " + to_text(place.id) : place.name) + " at " +
           place.path;
}

[[noreturn]] void fail_to_open(const JogPlace& place, int error) {
    if (error == EACCES || error == EPERM)
        fail(
            "{} may not be opened by this user: copy udev/70-vantage-jog.rules to "
            "/etc/udev/rules.d, run `udevadm control --reload` and plug it in again",
            described(place));
    fail("{} cannot be opened: {}", described(place), std::strerror(error));
}

class HidPort final : public JogPort {
  public:
    explicit HidPort(const JogPlace& place) : what_(described(place)) {
        // hidapi does not report the reason, so the node is checked first.
        if (access(place.path.c_str(), R_OK | W_OK) != 0) fail_to_open(place, errno);
        device_.reset(hid_open_path(place.path.c_str()));
        if (!device_) fail("{} cannot be opened: {}", what_, narrow(hid_error(nullptr)));
    }

    std::vector<std::uint8_t> read(std::chrono::milliseconds timeout) override {
        std::uint8_t report[max_report];
        const int bytes = hid_read_timeout(device_.get(), report, sizeof report,
                                           static_cast<int>(timeout.count()));
        if (bytes < 0) fail("{} is gone", what_);
        return {report, report + bytes};
    }

    void write(std::span<const std::uint8_t> report) override {
        if (hid_write(device_.get(), report.data(), report.size()) < 0)
            fail("{} takes no report: {}", what_, narrow(hid_error(device_.get())));
    }

    void send_feature(std::span<const std::uint8_t> report) override {
        if (hid_send_feature_report(device_.get(), report.data(), report.size()) < 0)
            fail("{} takes no feature report: {}", what_, narrow(hid_error(device_.get())));
    }

    std::vector<std::uint8_t> get_feature(std::uint8_t id, std::size_t size) override {
        std::vector<std::uint8_t> report(size);
        report[0] = id;
        const int bytes = hid_get_feature_report(device_.get(), report.data(), report.size());
        if (bytes < 0)
            fail("{} gives no feature report: {}", what_, narrow(hid_error(device_.get())));
        report.resize(static_cast<std::size_t>(bytes));
        return report;
    }

  private:
    static constexpr std::size_t max_report = 256;
    struct Inpainting {
        void operator()(hid_device* device) const { hid_close(device); }
    };
    std::string what_;
    std::unique_ptr<hid_device, Inpainting> device_;
};

class EvdevPort final : public JogPort {
  public:
    explicit EvdevPort(const JogPlace& place)
        : what_(described(place)),
          fd_(::open(place.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
        if (!fd_) fail_to_open(place, errno);
    }

    std::vector<std::uint8_t> read(std::chrono::milliseconds timeout) override {
        pollfd waiting{fd_.get(), POLLIN, 0};
        if (poll(&waiting, 1, static_cast<int>(timeout.count())) <= 0) return {};
        std::uint8_t events[64 * sizeof(input_event)];
        const ssize_t bytes = ::read(fd_.get(), events, sizeof events);
        if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return {};
        if (bytes <= 0) fail("{} is gone", what_);
        return {events, events + bytes};
    }

    void write(std::span<const std::uint8_t>) override { fail("{} takes no reports", what_); }
    void send_feature(std::span<const std::uint8_t>) override { write({}); }
    std::vector<std::uint8_t> get_feature(std::uint8_t, std::size_t) override {
        fail("{} gives no reports", what_);
    }

  private:
    std::string what_;
    UniqueFd fd_;
};

std::string first_line(const std::filesystem::path& file) {
    std::string line;
    std::getline(std::ifstream(file) >> std::ws, line);
    return line;
}

std::uint16_t hex_number(const std::string& text) {
    std::uint16_t number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number, 16);
    return number;
}

class SystemJogBus final : public JogBus {
  public:
    SystemJogBus() {
        if (hid_init() != 0) fail("hidapi cannot be started: {}", narrow(hid_error(nullptr)));
    }
    ~SystemJogBus() override { hid_exit(); }

    std::vector<JogPlace> list() override {
        std::vector<JogPlace> places;
        hid_device_info* const first = hid_enumerate(0, 0);
        for (const hid_device_info* info = first; info; info = info->next) {
            // hidapi may have no node for a device that is being unplugged.
            if (!info->path) continue;
            places.push_back({JogTransport::hidraw,
                              info->path,
                              {info->vendor_id, info->product_id},
                              narrow(info->product_string),
                              narrow(info->serial_number),
                              info->interface_number,
                              info->usage_page,
                              info->usage});
        }
        hid_free_enumeration(first);
        list_evdev(places);
        return places;
    }

    std::unique_ptr<JogPort> open(const JogPlace& place) override {
        if (place.transport == JogTransport::evdev) return std::make_unique<EvdevPort>(place);
        return std::make_unique<HidPort>(place);
    }

  private:
    /// Lists evdev nodes from sysfs, which every user may read.
    static void list_evdev(std::vector<JogPlace>& places) {
        std::error_code none;
        for (const auto& entry : std::filesystem::directory_iterator("/sys/class/input", none)) {
            const std::string node = entry.path().filename();
            if (!node.starts_with("event")) continue;
            const std::filesystem::path device = entry.path() / "device";
            places.push_back({JogTransport::evdev,
                              "/dev/input/" + node,
                              {hex_number(first_line(device / "id/vendor")),
                               hex_number(first_line(device / "id/product"))},
                              first_line(device / "name"),
                              first_line(device / "uniq")});
        }
    }
};

}  // namespace

std::unique_ptr<JogBus> make_system_jog_bus() { return std::make_unique<SystemJogBus>(); }

}  // namespace vantage
