#include <fmt/format.h>

#include "host_app/control/hid/jog_family.h"

namespace vantage {
namespace {

constexpr JogId xpress{0x0b33, 0x0020}, pro{0x0b33, 0x0010}, pro_v2{0x0b33, 0x0030};

/// Contour ShuttleXpress and ShuttlePRO: 5 bytes without a report id.
///   0     shuttle ring, signed, -7..7
///   1     jog counter, wraps at 256, grows clockwise
///   3, 4  mask of held buttons, little-endian; the Xpress has bits 4 to 8, the PRO 0 to 12, the
///         PRO v2 0 to 14
class ContourDecoder final : public JogDecoder {
  public:
    explicit ContourDecoder(JogId id) {
        if (id == xpress)
            first_bit_ = 4, buttons_ = 5;
        else
            buttons_ = id == pro ? 13 : 15;
    }

    std::vector<JogControl> controls() const override {
        std::vector<JogControl> all{{JogKind::step, "jog"}, {JogKind::axis, "shuttle"}};
        for (int bit = first_bit_; bit < first_bit_ + buttons_; ++bit)
            all.push_back({JogKind::button, button(bit)});
        return all;
    }

    bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) override {
        constexpr int last_notch = 7;
        if (report.size() != 5) return false;
        const int notch = int8_at(report, 0);
        if (notch < -last_notch || notch > last_notch) return false;
        // The counter's value at the time of opening has no meaning.
        const auto turned = static_cast<std::int8_t>(report[1] - counter_);
        if (has_counter_ && turned != 0) events.push_back({JogKind::step, "jog", double(turned)});
        counter_ = report[1];
        has_counter_ = true;
        shuttle_.update(double(notch) / last_notch, "shuttle", events);
        buttons_held_.update(
            uint16_at(report, 3), [&](int bit) { return button(bit); }, events);
        return true;
    }

  private:
    std::string button(int bit) const {
        if (bit < first_bit_ || bit >= first_bit_ + buttons_) return "";
        return fmt::format("b{}", bit - first_bit_ + 1);
    }

    int first_bit_ = 0, buttons_ = 0;
    bool has_counter_ = false;
    std::uint8_t counter_ = 0;
    AxisPosition shuttle_;
    HeldButtons buttons_held_;
};

}  // namespace

JogFamily contour_family_entry() {
    return {.name = "contour",
            .transport = JogTransport::hidraw,
            .models = {{xpress, "Contour ShuttleXpress"},
                       {pro, "Contour ShuttlePRO"},
                       {pro_v2, "Contour ShuttlePRO v2"}},
            .speaks = {},
            .make_decoder = [](JogId id) { return std::make_unique<ContourDecoder>(id); }};
}

}  // namespace vantage
