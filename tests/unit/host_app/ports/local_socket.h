#pragma once

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/base/files/unique_fd.h"

namespace vantage {

/// Somebody else on this computer, who sends and hears datagrams at a port of the system's choice.
class LocalSocket {
  public:
    LocalSocket() : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in any = place(0);
        ::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&any), sizeof any);
    }
    int port() const {
        sockaddr_in own{};
        socklen_t size = sizeof own;
        ::getsockname(fd_.get(), reinterpret_cast<sockaddr*>(&own), &size);
        return ntohs(own.sin_port);
    }
    void send(const void* bytes, std::size_t size, int port) const {
        const sockaddr_in to = place(port);
        ::sendto(fd_.get(), bytes, size, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
    void send(std::string_view bytes, int port) const { send(bytes.data(), bytes.size(), port); }
    /// Empty: nothing came within a second.
    std::string receive() const {
        pollfd waiting{fd_.get(), POLLIN, 0};
        if (::poll(&waiting, 1, 1000) <= 0) return "";
        std::vector<char> buffer(65536);
        const ssize_t size = ::recv(fd_.get(), buffer.data(), buffer.size(), 0);
        return size > 0 ? std::string(buffer.data(), static_cast<std::size_t>(size)) : "";
    }

  private:
    static sockaddr_in place(int port) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        return address;
    }
    UniqueFd fd_;
};

}  // namespace vantage
