#include "tests/support/free_ports.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/base/error.h"

namespace vantage {

std::pair<int, int> two_free_ports() {
    const auto bind_any = [](int socket) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        if (bind(socket, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
            getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0)
            fail("no free port on loopback");
        return static_cast<int>(ntohs(address.sin_port));
    };
    const int first = socket(AF_INET, SOCK_STREAM, 0), second = socket(AF_INET, SOCK_STREAM, 0);
    const std::pair ports(bind_any(first), bind_any(second));
    close(first);
    close(second);
    return ports;
}

}  // namespace vantage
