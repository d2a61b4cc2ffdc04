#include "tests/support/free_ports.h"

#include <vector>

#include <netinet/in.h>
#include <sys/socket.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"

namespace vantage {
namespace {

/// A socket that reserves a loopback port without listening.
UniqueFd holding(int& port) {
    UniqueFd held(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* plain = reinterpret_cast<sockaddr*>(&address);
    const int shared = 1;
    // Only after the port is chosen, so that it is not one that another test has reserved.
    if (!held || bind(held.get(), plain, size) != 0 || getsockname(held.get(), plain, &size) != 0 ||
        setsockopt(held.get(), SOL_SOCKET, SO_REUSEADDR, &shared, sizeof shared) != 0)
        fail("no free port on loopback");
    port = ntohs(address.sin_port);
    return held;
}

}  // namespace

std::pair<int, int> two_free_ports() {
    static std::vector<UniqueFd> held;
    std::pair<int, int> ports;
    held.push_back(holding(ports.first));
    held.push_back(holding(ports.second));
    return ports;
}

}  // namespace vantage
