#include "rig_firmware/clock/ptp4l_client.h"

#include <array>
#include <cstring>
#include <string_view>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/base/files/unique_fd.h"
#include "common/wire/random_id.h"

namespace vantage {
namespace {

// Offsets in a management message (IEEE 1588-2008, 13.3 and 15.4), all big-endian.
constexpr std::size_t length_at = 2, sequence_at = 30, control_at = 32, interval_at = 33,
                      target_at = 34, action_at = 46, tlv_at = 48, id_at = 52, data_at = 54;
constexpr std::uint8_t management_message = 0x0d, ptp_version = 2, management_control = 4;
constexpr std::uint8_t response_action = 2;
constexpr std::uint16_t management_tlv = 1;
constexpr std::size_t target_bytes = 10;

std::uint64_t read_big_endian(std::span<const std::byte> bytes, std::size_t at, std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8 | std::to_integer<std::uint64_t>(bytes[at + i]);
    return value;
}

void write_big_endian(std::vector<std::byte>& bytes, std::size_t at, std::uint16_t value) {
    bytes[at] = static_cast<std::byte>(value >> 8);
    bytes[at + 1] = static_cast<std::byte>(value & 0xff);
}

/// A TimeInterval: nanoseconds, in 1/65536.
double read_interval_ns(std::span<const std::byte> bytes, std::size_t at) {
    constexpr double parts = 65536;
    return static_cast<double>(static_cast<std::int64_t>(read_big_endian(bytes, at, 8))) / parts;
}

std::string port_state_name(std::uint8_t state) {
    constexpr std::array<std::string_view, 10> names = {
        "NONE",       "INITIALIZING", "FAULTY",  "DISABLED",     "LISTENING",
        "PRE_MASTER", "MASTER",       "PASSIVE", "UNCALIBRATED", "SLAVE"};
    return std::string(state < names.size() ? names[state] : "UNKNOWN");
}

/// A socket with an address of its own, which answers come back to.
class ClientSocket {
  public:
    explicit ClientSocket(const std::filesystem::path& server)
        : fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un own{};
        own.sun_family = AF_UNIX;
        sockaddr_un theirs = own;
        const std::string text = server.string();
        if (text.size() >= sizeof theirs.sun_path) return;
        std::memcpy(theirs.sun_path, text.c_str(), text.size() + 1);
        path_ =
            std::filesystem::temp_directory_path() / ("vantage-ptp-" + std::to_string(random_id()));
        std::memcpy(own.sun_path, path_.c_str(), path_.string().size() + 1);
        is_open_ = fd_ && ::bind(fd_.get(), reinterpret_cast<sockaddr*>(&own), sizeof own) == 0 &&
                   ::connect(fd_.get(), reinterpret_cast<sockaddr*>(&theirs), sizeof theirs) == 0;
    }
    ~ClientSocket() {
        if (!path_.empty()) ::unlink(path_.c_str());
    }
    ClientSocket(const ClientSocket&) = delete;
    ClientSocket& operator=(const ClientSocket&) = delete;

    bool ask(PtpDataSet data_set, std::uint16_t sequence, std::chrono::milliseconds timeout,
             PtpState& state) const {
        const std::vector<std::byte> question = ptp_get_message(data_set, sequence);
        if (!is_open_ || ::send(fd_.get(), question.data(), question.size(), MSG_NOSIGNAL) < 0)
            return false;
        pollfd wait{.fd = fd_.get(), .events = POLLIN, .revents = 0};
        while (::poll(&wait, 1, static_cast<int>(timeout.count())) > 0) {
            std::array<std::byte, 1500> answer{};
            const ssize_t size = ::recv(fd_.get(), answer.data(), answer.size(), MSG_DONTWAIT);
            if (size < 0) return false;
            if (read_ptp_answer(std::span(answer).first(static_cast<std::size_t>(size)), data_set,
                                state))
                return true;
        }
        return false;
    }

  private:
    UniqueFd fd_;
    std::filesystem::path path_;
    bool is_open_ = false;
};

}  // namespace

std::vector<std::byte> ptp_get_message(PtpDataSet data_set, std::uint16_t sequence) {
    std::vector<std::byte> message(data_at);
    message[0] = std::byte{management_message};
    message[1] = std::byte{ptp_version};
    write_big_endian(message, length_at, static_cast<std::uint16_t>(message.size()));
    write_big_endian(message, sequence_at, sequence);
    message[control_at] = std::byte{management_control};
    message[interval_at] = std::byte{0x7f};
    for (std::size_t i = 0; i < target_bytes; ++i) message[target_at + i] = std::byte{0xff};
    write_big_endian(message, tlv_at, management_tlv);
    write_big_endian(message, tlv_at + 2, 2);
    write_big_endian(message, id_at, static_cast<std::uint16_t>(data_set));
    return message;
}

bool read_ptp_answer(std::span<const std::byte> message, PtpDataSet data_set, PtpState& state) {
    const std::size_t data_bytes = data_set == PtpDataSet::current ? 18 : 11;
    if (message.size() < data_at + data_bytes ||
        (std::to_integer<unsigned>(message[0]) & 0x0fu) != management_message ||
        (std::to_integer<unsigned>(message[action_at]) & 0x0fu) != response_action ||
        read_big_endian(message, tlv_at, 2) != management_tlv ||
        read_big_endian(message, id_at, 2) != static_cast<std::uint16_t>(data_set))
        return false;
    if (data_set == PtpDataSet::current) {
        state.steps_removed = static_cast<int>(read_big_endian(message, data_at, 2));
        state.offset_ns = read_interval_ns(message, data_at + 2);
        state.path_delay_ns = read_interval_ns(message, data_at + 10);
    } else {
        constexpr std::size_t identity_bytes = 10;
        state.port_state =
            port_state_name(std::to_integer<std::uint8_t>(message[data_at + identity_bytes]));
    }
    return true;
}

std::optional<PtpState> read_ptp4l(const std::filesystem::path& socket,
                                   std::chrono::milliseconds timeout) {
    std::error_code ignored;
    if (!std::filesystem::is_socket(socket, ignored)) return std::nullopt;
    const ClientSocket client(socket);
    PtpState state;
    if (!client.ask(PtpDataSet::current, 1, timeout, state) ||
        !client.ask(PtpDataSet::port, 2, timeout, state))
        return std::nullopt;
    return state;
}

}  // namespace vantage
