#include "host_app/control/hid/simulated_wheel.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>

#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr int last_notch = 7, most_detents = 100, buttons = 5, first_button_bit = 4;

void write_event(int fd, const uhid_event& event) {
    if (write(fd, &event, sizeof event) < 0) fail("/dev/uhid: {}", std::strerror(errno));
}

}  // namespace

SimulatedXpress::Report SimulatedXpress::report(std::uint16_t held) const {
    return {static_cast<std::uint8_t>(ring_), counter_, 0, static_cast<std::uint8_t>(held & 0xff),
            static_cast<std::uint8_t>(held >> 8)};
}

std::vector<SimulatedXpress::Report> SimulatedXpress::reports_of(const std::string& line) {
    std::istringstream text(line);
    std::string control, more;
    text >> control;
    const auto number = [&](int most) {
        int value = 0;
        if (!(text >> value) || value < -most || value > most)
            fail("'{}' is not understood: after '{}' comes a number from {} to {}", line, control,
                 -most, most);
        return value;
    };
    std::vector<Report> reports{report()};
    if (control == "jog") {
        const int detents = number(most_detents);
        for (int i = 0; i != detents; i += detents > 0 ? 1 : -1) {
            counter_ = static_cast<std::uint8_t>(counter_ + (detents > 0 ? 1 : -1));
            reports.push_back(report());
        }
    } else if (control == "shuttle") {
        ring_ = static_cast<std::int8_t>(number(last_notch));
        reports.push_back(report());
    } else if (control.size() == 2 && control[0] == 'b' && control[1] > '0' &&
               control[1] <= '0' + buttons) {
        const int bit = first_button_bit + control[1] - '1';
        reports.push_back(report(static_cast<std::uint16_t>(1U << static_cast<unsigned>(bit))));
        reports.push_back(report());
    } else {
        fail("'{}' is not understood; words are: {}", line, words);
    }
    if (text >> more) fail("'{}' is not understood: nothing comes after '{}'", line, control);
    return reports;
}

std::vector<std::uint8_t> UhidWheel::input_of(std::uint8_t bytes) {
    return {0x06, 0x00, 0xff,                                       // usage page: vendor
            0x09, 0x01,                                             // usage 1
            0xa1, 0x01,                                             // collection: application
            0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08, 0x95, bytes,  // bytes of 8 bits, 0..255
            0x09, 0x01, 0x81, 0x02,                                 // input
            0xc0};
}

UhidWheel::UhidWheel(Kind kind)
    : kind_(std::move(kind)), fd_(open("/dev/uhid", O_RDWR | O_CLOEXEC)) {
    if (!fd_ && errno == ENOENT)
        fail("a simulated wheel needs the kernel's /dev/uhid, which is not there: modprobe uhid");
    if (!fd_)
        fail(
            "a simulated wheel needs the kernel's /dev/uhid, which cannot be opened: {}; run this "
            "as root",
            std::strerror(errno));
    uhid_event event{};
    event.type = UHID_CREATE2;
    auto& create = event.u.create2;
    std::strncpy(reinterpret_cast<char*>(create.name), kind_.name.c_str(), sizeof create.name - 1);
    std::copy(kind_.descriptor.begin(), kind_.descriptor.end(), create.rd_data);
    create.rd_size = static_cast<std::uint16_t>(kind_.descriptor.size());
    create.bus = BUS_USB;
    create.vendor = kind_.vendor;
    create.product = kind_.product;
    write_event(fd_.get(), event);
    thread_ = std::jthread([this](const std::stop_token& stop) { answer(stop); });
}

UhidWheel::~UhidWheel() {
    thread_.request_stop();
    thread_.join();
    uhid_event event{};
    event.type = UHID_DESTROY;
    if (write(fd_.get(), &event, sizeof event) < 0) std::perror("/dev/uhid");
}

void UhidWheel::send(const std::vector<std::uint8_t>& report) const {
    uhid_event event{};
    event.type = UHID_INPUT2;
    event.u.input2.size = static_cast<std::uint16_t>(report.size());
    std::copy(report.begin(), report.end(), event.u.input2.data);
    write_event(fd_.get(), event);
}

void UhidWheel::answer(const std::stop_token& stop) const {
    while (!stop.stop_requested()) {
        pollfd waiting{fd_.get(), POLLIN, 0};
        if (poll(&waiting, 1, 20) <= 0) continue;
        uhid_event asked{};
        if (read(fd_.get(), &asked, sizeof asked) <= 0) continue;
        uhid_event reply{};
        if (asked.type == UHID_GET_REPORT) {
            reply.type = UHID_GET_REPORT_REPLY;
            reply.u.get_report_reply.id = asked.u.get_report.id;
            const std::vector<std::uint8_t> report =
                kind_.get_feature ? kind_.get_feature(asked.u.get_report.rnum)
                                  : std::vector<std::uint8_t>();
            reply.u.get_report_reply.err = report.empty() ? EIO : 0;
            reply.u.get_report_reply.size = static_cast<std::uint16_t>(report.size());
            std::copy(report.begin(), report.end(), reply.u.get_report_reply.data);
            write_event(fd_.get(), reply);
        } else if (asked.type == UHID_SET_REPORT) {
            reply.type = UHID_SET_REPORT_REPLY;
            reply.u.set_report_reply.id = asked.u.set_report.id;
            if (kind_.set_feature)
                kind_.set_feature({asked.u.set_report.data, asked.u.set_report.size});
            write_event(fd_.get(), reply);
        }
    }
}

}  // namespace vantage
