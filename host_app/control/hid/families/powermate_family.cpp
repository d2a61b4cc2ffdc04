#include <cstring>

#include <linux/input.h>

#include "host_app/control/hid/jog_family.h"

namespace vantage {
namespace {

/// Griffin PowerMate. The kernel has its own driver for it, so that it delivers evdev events:
/// REL_DIAL, about 94 per turn, and BTN_0 for a press.
class PowerMateDecoder final : public JogDecoder {
  public:
    std::vector<JogControl> controls() const override {
        return {{JogKind::step, "jog"}, {JogKind::button, "press"}};
    }

    bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) override {
        if (report.empty() || report.size() % sizeof(input_event) != 0) return false;
        for (std::size_t at = 0; at < report.size(); at += sizeof(input_event)) {
            input_event event;
            std::memcpy(&event, report.data() + at, sizeof event);
            if (event.type == EV_REL && event.code == REL_DIAL && event.value != 0)
                events.push_back({JogKind::step, "jog", double(event.value)});
            // 2 is the kernel's auto-repeat of a held key.
            if (event.type == EV_KEY && event.code == BTN_0 && event.value != 2)
                events.push_back({JogKind::button, "press", event.value != 0 ? 1.0 : 0.0});
        }
        return true;
    }
};

}  // namespace

JogFamily powermate_family_entry() {
    return {.name = "powermate",
            .transport = JogTransport::evdev,
            .models = {{{0x077d, 0x0410}, "Griffin PowerMate"}},
            .speaks = [](const JogPlace&) { return true; },
            .make_decoder = [](JogId) { return std::make_unique<PowerMateDecoder>(); }};
}

}  // namespace vantage
