#include "tests/hil/devices/uinput_wheel.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "common/base/error.h"

namespace vantage {

UinputWheel::UinputWheel() : fd_(open("/dev/uinput", O_WRONLY | O_CLOEXEC)) {
    if (!fd_) fail("/dev/uinput cannot be opened: {}", std::strerror(errno));
    uinput_setup setup{};
    setup.id = {.bustype = BUS_USB, .vendor = 0x077d, .product = 0x0410, .version = 0x0400};
    std::strncpy(setup.name, "Griffin PowerMate", sizeof setup.name - 1);
    const int fd = fd_.get();
    if (ioctl(fd, UI_SET_EVBIT, EV_REL) < 0 || ioctl(fd, UI_SET_RELBIT, REL_DIAL) < 0 ||
        ioctl(fd, UI_SET_EVBIT, EV_KEY) < 0 || ioctl(fd, UI_SET_KEYBIT, BTN_0) < 0 ||
        ioctl(fd, UI_DEV_SETUP, &setup) < 0 || ioctl(fd, UI_DEV_CREATE) < 0)
        fail("/dev/uinput makes no wheel: {}", std::strerror(errno));
}

void UinputWheel::turn(int steps) const { send(EV_REL, REL_DIAL, steps); }

void UinputWheel::press(bool held) const { send(EV_KEY, BTN_0, held ? 1 : 0); }

void UinputWheel::send(std::uint16_t type, std::uint16_t code, int value) const {
    std::array<input_event, 2> events{};
    events[0].type = type;
    events[0].code = code;
    events[0].value = value;
    events[1].type = EV_SYN;
    if (write(fd_.get(), events.data(), sizeof events) < 0)
        fail("/dev/uinput: {}", std::strerror(errno));
}

}  // namespace vantage
