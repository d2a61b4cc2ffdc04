#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "host_app/control/hid/jog_family.h"

namespace vantage {
namespace {

/// 3Dconnexion's six-axis controllers.
///   report 1  int16 tx, ty, tz; of the wireless ones and the Enterprise rx, ry, rz as well
///   report 2  int16 rx, ry, rz of all others
///   report 3  mask of held buttons, up to 32
/// Full scale is about 350. The device's axes: x right, y towards the operator, z down.
class SpaceMouseDecoder final : public JogDecoder {
  public:
    std::vector<JogControl> controls() const override {
        std::vector<JogControl> all;
        for (const char* axis : axis_names) all.push_back({JogKind::axis, axis});
        for (int bit = 0; bit < max_buttons; ++bit) all.push_back({JogKind::button, button(bit)});
        return all;
    }

    void start(JogPort& port, MonotonicTime) override {
        constexpr std::uint8_t lamp_on[] = {4, 1};
        port.write(lamp_on);
    }

    bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) override {
        constexpr std::size_t three_axes = 1 + 6, six_axes = 1 + 12;
        if (report.size() < 2) return false;
        switch (report[0]) {
            case 1:
                if (report.size() < three_axes) return false;
                update(report, 0, report.size() >= six_axes ? 6 : 3, events);
                return true;
            case 2:
                if (report.size() < three_axes) return false;
                update(report, 3, 3, events);
                return true;
            case 3: {
                const std::size_t bytes = std::min<std::size_t>(report.size() - 1, 4);
                buttons_.update(uint_at(report, 1, bytes), button, events);
                return true;
            }
            default:
                // Reports of the battery, calibration and long presses need no action.
                return true;
        }
    }

  private:
    static constexpr std::array<const char*, 6> axis_names{"tx", "ty", "tz", "rx", "ry", "rz"};
    static constexpr int max_buttons = 32;
    static constexpr double full_scale = 350;

    static std::string button(int bit) { return fmt::format("b{}", bit + 1); }

    void update(std::span<const std::uint8_t> report, std::size_t first, std::size_t count,
                std::vector<JogEvent>& events) {
        for (std::size_t i = 0; i < count; ++i)
            axes_[first + i].update(std::clamp(int16_at(report, 1 + 2 * i) / full_scale, -1.0, 1.0),
                                    axis_names[first + i], events);
    }

    std::array<AxisPosition, 6> axes_;
    HeldButtons buttons_;
};

/// True for the interface of a multi-axis controller; a receiver has other interfaces too.
bool is_multi_axis(const JogPlace& place) {
    constexpr std::uint16_t generic_desktop = 1, multi_axis_controller = 8;
    if (place.usage_page == 0) return place.interface_number <= 0;
    return place.usage_page == generic_desktop && place.usage == multi_axis_controller;
}

}  // namespace

JogFamily spacemouse_family_entry() {
    return {.name = "spacemouse",
            .transport = JogTransport::hidraw,
            .models = {{{0x046d, 0xc626}, "3Dconnexion SpaceNavigator"},
                       {{0x046d, 0xc62b}, "3Dconnexion SpaceMouse Pro"},
                       {{0x256f, 0xc635}, "3Dconnexion SpaceMouse Compact"},
                       {{0x256f, 0xc62e}, "3Dconnexion SpaceMouse Wireless"},
                       {{0x256f, 0xc63a}, "3Dconnexion SpaceMouse Wireless"},
                       {{0x256f, 0xc632}, "3Dconnexion SpaceMouse Pro Wireless"},
                       {{0x256f, 0xc638}, "3Dconnexion SpaceMouse Pro Wireless"},
                       {{0x256f, 0xc633}, "3Dconnexion SpaceMouse Enterprise"},
                       {{0x256f, 0xc652}, "3Dconnexion Universal Receiver"}},
            .speaks = is_multi_axis,
            .make_decoder = [](JogId) { return std::make_unique<SpaceMouseDecoder>(); }};
}

}  // namespace vantage
