#include <fmt/format.h>

#include "host_app/control/hid/jog_family.h"

namespace vantage {
namespace {

constexpr JogId xk12[] = {{0x05f3, 0x0426}, {0x05f3, 0x0428}};
constexpr JogId xk68[] = {{0x05f3, 0x045a}, {0x05f3, 0x045c}};

/// P.I. Engineering X-keys with a jog & shuttle knob, no report id.
///   0     unit id
///   1     bit 0: program switch; 214: a report of another kind (version)
///   2...  one byte per column of keys, bit 0 is its top row: 10 columns on the XK-68, 4 on the
///         XK-12
///   then  jog, signed: detents since the previous report; shuttle, signed, -7..7; four bytes
///         of time. They begin at byte 16 on the XK-68, at byte 6 on the XK-12
class XkeysDecoder final : public JogDecoder {
  public:
    explicit XkeysDecoder(JogId id) {
        const bool is_68 = id == xk68[0] || id == xk68[1];
        columns_ = is_68 ? 10 : 4;
        rows_ = is_68 ? 8 : 3;
        jog_at_ = is_68 ? 16 : 6;
        columns_held_.resize(columns_);
    }

    std::vector<JogControl> controls() const override {
        std::vector<JogControl> all{
            {JogKind::step, "jog"}, {JogKind::axis, "shuttle"}, {JogKind::button, program_switch}};
        for (std::size_t column = 0; column < columns_; ++column)
            for (int row = 0; row < rows_; ++row)
                all.push_back({JogKind::button, key(column, row)});
        return all;
    }

    bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) override {
        constexpr std::uint8_t version_report = 214;
        constexpr std::size_t knobs_and_time = 6;
        constexpr double last_notch = 7;
        if (report.size() < jog_at_ + knobs_and_time) return false;
        if (report[1] == version_report) return true;
        const int notch = int8_at(report, jog_at_ + 1);
        if (notch < -last_notch || notch > last_notch) return false;
        if (const int turned = int8_at(report, jog_at_); turned != 0)
            events.push_back({JogKind::step, "jog", double(turned)});
        shuttle_.update(notch / last_notch, "shuttle", events);
        switch_.update(
            report[1] & 1U, [](int) { return std::string(program_switch); }, events);
        for (std::size_t column = 0; column < columns_; ++column)
            columns_held_[column].update(
                report[2 + column],
                [&](int row) { return row < rows_ ? key(column, row) : std::string(); }, events);
        return true;
    }

  private:
    static constexpr const char* program_switch = "program_switch";

    static std::string key(std::size_t column, int row) {
        return fmt::format("r{}c{}", row + 1, column + 1);
    }

    std::size_t columns_ = 0, jog_at_ = 0;
    int rows_ = 0;
    AxisPosition shuttle_;
    HeldButtons switch_;
    std::vector<HeldButtons> columns_held_;
};

}  // namespace

JogFamily xkeys_family_entry() {
    return {.name = "xkeys",
            .transport = JogTransport::hidraw,
            .models = {{xk12[0], "X-keys XK-12 Jog & Shuttle"},
                       {xk12[1], "X-keys XK-12 Jog & Shuttle"},
                       {xk68[0], "X-keys XK-68 Jog & Shuttle"},
                       {xk68[1], "X-keys XK-68 Jog & Shuttle"}},
            .speaks = {},
            .make_decoder = [](JogId id) { return std::make_unique<XkeysDecoder>(id); }};
}

}  // namespace vantage
