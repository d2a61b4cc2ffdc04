#include "host_app/control/hid/speed_editor_handshake.h"

#include <array>
#include <bit>

#include "common/base/error.h"
#include "host_app/control/hid/report_bytes.h"

namespace vantage {
namespace {

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

}  // namespace

std::uint64_t speed_editor_response(std::uint64_t challenge_number) {
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

std::chrono::seconds open_speed_editor(JogPort& port) {
    send(port, challenge, 0);
    const std::uint64_t number = receive(port, challenge);
    // The protocol lets the device prove its identity too, which the host does not need.
    send(port, own_challenge, 0);
    receive(port, answer);
    send(port, response, speed_editor_response(number));
    return std::chrono::seconds(receive(port, verdict) & 0xffff);
}

}  // namespace vantage
