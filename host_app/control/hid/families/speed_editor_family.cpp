#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "common/base/error.h"
#include "host_app/control/hid/jog_family.h"

namespace vantage {
namespace {

struct Key {
    std::uint16_t code;
    const char* name;
};
constexpr Key keys[] = {{0x01, "smart_insert"}, {0x02, "append"},      {0x03, "ripple_overwrite"},
                        {0x04, "close_up"},     {0x05, "on_top"},      {0x06, "source_overwrite"},
                        {0x07, "in"},           {0x08, "out"},         {0x09, "trim_in"},
                        {0x0a, "trim_out"},     {0x0b, "roll"},        {0x0c, "slip_source"},
                        {0x0d, "slip_dest"},    {0x0e, "trans_dur"},   {0x0f, "cut"},
                        {0x10, "dissolve"},     {0x11, "smooth_cut"},  {0x1a, "source"},
                        {0x1b, "timeline"},     {0x1c, "shuttle_key"}, {0x1d, "jog_key"},
                        {0x1e, "scroll_key"},   {0x1f, "sync_bin"},    {0x22, "transition"},
                        {0x25, "video_only"},   {0x26, "audio_only"},  {0x2b, "ripple_delete"},
                        {0x2c, "audio_level"},  {0x2d, "full_view"},   {0x2e, "snap"},
                        {0x2f, "split"},        {0x30, "live"},        {0x31, "esc"},
                        {0x33, "cam1"},         {0x34, "cam2"},        {0x35, "cam3"},
                        {0x36, "cam4"},         {0x37, "cam5"},        {0x38, "cam6"},
                        {0x39, "cam7"},         {0x3a, "cam8"},        {0x3b, "cam9"},
                        {0x3c, "stop_play"}};
constexpr std::uint16_t shuttle_key = 0x1c, jog_key = 0x1d, scroll_key = 0x1e;

constexpr std::uint8_t handshake_report = 6;
constexpr std::size_t report_bytes = 10;
enum Step : std::uint8_t {
    challenge = 0,
    own_challenge = 1,
    answer = 2,
    response = 3,
    verdict = 4
};

void send(JogPort& port, Step step, std::uint64_t number) {
    std::array<std::uint8_t, report_bytes> report{handshake_report, step};
    for (std::size_t i = 0; i < 8; ++i)
        report[2 + i] = static_cast<std::uint8_t>(number >> (8 * i));
    port.send_feature(report);
}

/// Receives the number of one step of the handshake.
std::uint64_t receive(JogPort& port, Step step) {
    const std::vector<std::uint8_t> report = port.get_feature(handshake_report, report_bytes);
    if (report.size() < report_bytes || report[0] != handshake_report || report[1] != step)
        fail(
            "the Speed Editor does not follow its opening procedure at step {}; unplug it, plug it "
            "in again and close other programs that use it",
            static_cast<int>(step));
    return uint_at(report, 2, 8);
}

/// Response that a DaVinci Resolve Speed Editor expects to its challenge. S. Munaut found and
/// published the procedure and its constants (blackmagic-misc, bmd.py, 2021).
std::uint64_t response_to(std::uint64_t challenge_number) {
    constexpr std::uint64_t even[] = {0x3ae1206f97c10bc8, 0x2a9ab32bebf244c6, 0x20a6f8b8df9adf0a,
                                      0xaf80ece52cfc1719, 0xec2ee2f7414fd151, 0xb055adfd73344a15,
                                      0xa63d2e3059001187, 0x751bf623f42e0dde};
    constexpr std::uint64_t odd[] = {0x3e22b34f502e7fde, 0x24656b981875ab1c, 0xa17f3456df7bf8c3,
                                     0x6df72e1941aef698, 0x72226f011e66ab94, 0x3831a3c606296b42,
                                     0xfd7ff81881332c89, 0x61a3f6474ff236c6};
    constexpr std::uint64_t mask = 0xa79a63f585d37bf0;
    const int n = static_cast<int>(challenge_number & 7);
    std::uint64_t v = std::rotr(challenge_number, 8 * n);
    const bool is_even = (v & 1) == ((0x78U >> n) & 1);
    if (!is_even) v ^= std::rotr(v, 8);
    return v ^ (std::rotr(v, 8) & mask) ^ (is_even ? even : odd)[n];
}

/// Unlocks a Speed Editor over feature report 6; the device sends nothing before. Returns how long
/// it stays unlocked. Throws Error if the device does not follow the procedure.
std::chrono::seconds unlock(JogPort& port) {
    send(port, challenge, 0);
    const std::uint64_t number = receive(port, challenge);
    // The protocol lets the device prove its identity too, which the host does not need.
    send(port, own_challenge, 0);
    receive(port, answer);
    send(port, response, response_to(number));
    return std::chrono::seconds(receive(port, verdict) & 0xffff);
}

/// DaVinci Resolve Speed Editor.
///   report 3  u8 mode of the wheel, int32 value, u8: steps since the previous report in modes 0
///             and 2, position in modes 1 and 3; 8192 are about one turn
///   report 4  up to six held keys, u16 each
///   report 7  u8 charging, u8 battery in percent
/// Its keys JOG and SCRL make the wheel count steps; SHTL makes it a shuttle. These modes belong to
/// the device, so that this class sets them and not the profile. As a shuttle the wheel has no
/// spring; its zero is the position at which SHTL was pressed, with a dead zone in the device.
class SpeedEditorDecoder final : public JogDecoder {
  public:
    std::vector<JogControl> controls() const override {
        std::vector<JogControl> all{{JogKind::step, "jog"}, {JogKind::axis, "shuttle"}};
        for (const Key& key : keys) all.push_back({JogKind::button, key.name});
        return all;
    }

    void start(JogPort& port, MonotonicTime now) override {
        open(port, now);
        set_wheel(port, as_jog);
    }

    void keep_alive(JogPort& port, MonotonicTime now) override {
        if (renew_at_ && now >= *renew_at_) open(port, now);
        if (wanted_) set_wheel(port, *wanted_);
        wanted_.reset();
    }

    bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) override {
        if (report.empty()) return false;
        switch (report[0]) {
            case 3:
                return decode_wheel(report, events);
            case 4:
                return decode_keys(report, events);
            case 7:
                return report.size() >= 3;
            default:
                return false;
        }
    }

  private:
    enum WheelMode : std::uint8_t { as_jog = 0, as_shuttle = 3 };
    static constexpr double units_per_step = 8192.0 / 32;
    static constexpr double full_shuttle = 4096;

    void open(JogPort& port, MonotonicTime now) {
        constexpr std::chrono::seconds margin{60}, least{10};
        renew_at_ = now + std::max(unlock(port) - margin, least);
    }

    static void set_wheel(JogPort& port, WheelMode mode) {
        const std::uint8_t choose[] = {3, mode, 0, 0, 0, 0, 255};
        port.write(choose);
        const std::uint8_t lamp[] = {4, static_cast<std::uint8_t>(mode == as_jog ? 1 : 2)};
        port.write(lamp);
    }

    bool decode_wheel(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) {
        if (report.size() < 6) return false;
        const auto value = static_cast<std::int32_t>(uint_at(report, 2, 4));
        const bool is_position = report[1] == 1 || report[1] == 3;
        if (is_position) {
            move_shuttle(std::clamp(value / full_shuttle, -1.0, 1.0), events);
        } else {
            move_shuttle(0, events);
            if (value != 0) events.push_back({JogKind::step, "jog", value / units_per_step});
        }
        return true;
    }

    void move_shuttle(double to, std::vector<JogEvent>& events) {
        if (to != shuttle_) events.push_back({JogKind::axis, "shuttle", to});
        shuttle_ = to;
    }

    bool decode_keys(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) {
        std::array<std::uint16_t, 6> now{};
        if (report.size() < 1 + 2 * now.size()) return false;
        for (std::size_t i = 0; i < now.size(); ++i) now[i] = uint16_at(report, 1 + 2 * i);
        const auto holds = [](const std::array<std::uint16_t, 6>& held, std::uint16_t code) {
            return std::find(held.begin(), held.end(), code) != held.end();
        };
        for (const Key& key : keys) {
            const bool is_held = holds(now, key.code);
            if (is_held == holds(held_, key.code)) continue;
            events.push_back({JogKind::button, key.name, is_held ? 1.0 : 0.0});
            if (is_held && key.code == shuttle_key) wanted_ = as_shuttle;
            if (is_held && (key.code == jog_key || key.code == scroll_key)) wanted_ = as_jog;
            if (wanted_ == as_jog) move_shuttle(0, events);
        }
        held_ = now;
        return true;
    }

    std::optional<MonotonicTime> renew_at_;
    std::optional<WheelMode> wanted_;
    std::array<std::uint16_t, 6> held_{};
    double shuttle_ = 0;
};

}  // namespace

JogFamily speed_editor_family_entry() {
    return {.name = "speed_editor",
            .transport = JogTransport::hidraw,
            .models = {{{0x1edb, 0xda0e}, "DaVinci Resolve Speed Editor"}},
            .speaks = {},
            .make_decoder = [](JogId) { return std::make_unique<SpeedEditorDecoder>(); }};
}

}  // namespace vantage
