#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "host_app/control/ports/sockets.h"
#include "tests/support/free_ports.h"
#include "tests/support/thrown_sentence.h"
#include "tests/support/two_addresses.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::byte message[] = {std::byte{'h'}, std::byte{'i'}};

/// Whether this computer has IPv6 at all.
bool has_ipv6(int port) {
    const UniqueFd fd(::socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    const SocketAddress own = resolve_all("::1", port, "the test").front();
    return fd && ::bind(fd.get(), own.get(), own.size) == 0;
}

TEST(UdpSocket, ListensAtEveryAddressOfAName) {
    const int port = two_free_ports().first;
    const auto addresses = resolve_all("localhost", port, "the test");
    UdpSocket socket = UdpSocket::bound({"localhost", port, true}, "the test");
    for (const SocketAddress& address : addresses) {
        if (address.family() == AF_INET6 && !has_ipv6(two_free_ports().first)) continue;
        ASSERT_TRUE(UdpSocket::sending(address).send(message, address)) << address.text();
        const auto heard = socket.receive(5s);
        ASSERT_TRUE(heard) << address.text();
        EXPECT_EQ(heard->bytes.size(), 2u);
        EXPECT_TRUE(socket.send(message, heard->from)) << "an answer goes the same way";
    }
}

TEST(UdpSocket, ListensAtBothAddressesOfAName) {
    const int port = two_free_ports().first;
    const auto addresses = resolve_all(name_of_two_addresses, port, "the test");
    ASSERT_EQ(addresses.size(), 2u);
    UdpSocket socket = UdpSocket::bound({name_of_two_addresses, port, true}, "the test");
    for (const SocketAddress& address : addresses) {
        if (address.family() == AF_INET6 && !has_ipv6(two_free_ports().first)) continue;
        ASSERT_TRUE(UdpSocket::sending(address).send(message, address)) << address.text();
        EXPECT_TRUE(socket.receive(5s)) << address.text();
    }
}

TEST(UdpSocket, OfAllIpv6AddressesHearsIpv4Too) {
    const int port = two_free_ports().first;
    if (!has_ipv6(port)) GTEST_SKIP() << "SKIPPED: this computer has no IPv6";
    UdpSocket socket = UdpSocket::bound({"[::]", port, false}, "the test");
    const SocketAddress own = resolve_all("127.0.0.1", port, "the test").front();
    ASSERT_TRUE(UdpSocket::sending(own).send(message, own));
    EXPECT_TRUE(socket.receive(5s));
}

TEST(UdpSocket, SendsToTheFirstAddressOfANameThatHasARoute) {
    const SocketAddress own = resolve_all("127.0.0.1", 9, "the test").front();
    // A socket may not send to all computers unless it is told so.
    const SocketAddress closed = resolve_all("255.255.255.255", 9, "the test").front();
    testing::internal::CaptureStderr();
    EXPECT_EQ(first_with_route({closed, own}, "the test").text(), "127.0.0.1:9");
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_NE(log.find("no way to 255.255.255.255:9"), std::string::npos) << log;
    EXPECT_EQ(first_with_route({own, closed}, "the test").text(), "127.0.0.1:9");
    EXPECT_EQ(first_with_route({closed}, "the test").text(), "255.255.255.255:9")
        << "the only address";
}

TEST(UdpSocket, JoinsAGroup) {
    const int port = two_free_ports().first;
    UdpSocket socket = UdpSocket::bound({"239.255.77.3", port, false}, "the test");
    UdpSocket second = UdpSocket::bound({"239.255.77.3", port, false}, "another program");
    const UniqueFd sender(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    in_addr loopback{htonl(INADDR_LOOPBACK)};
    ASSERT_EQ(setsockopt(sender.get(), IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback), 0);
    const SocketAddress group = resolve_all("239.255.77.3", port, "the test").front();
    ASSERT_EQ(::sendto(sender.get(), message, sizeof message, 0, group.get(), group.size), 2);
    EXPECT_TRUE(socket.receive(5s));
    EXPECT_TRUE(second.receive(5s));
}

TEST(UdpSocket, NamesEveryAddressThatCannotBeHad) {
    const int port = two_free_ports().first;
    const UdpSocket taken = UdpSocket::bound({"127.0.0.1", port, true}, "the first");
    const std::string sentence = thrown_sentence([&] {
        (void)UdpSocket::bound({"127.0.0.1", port, true}, "the second");
    });
    EXPECT_NE(sentence.find(fmt::format("127.0.0.1:{}", port)), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("choose another"), std::string::npos) << sentence;
    EXPECT_NE(thrown_sentence([&] {
                  (void)UdpSocket::bound({"no-such-host.invalid", port, true}, "the third");
              }).find("does not resolve"),
              std::string::npos);
}

TEST(TcpListener, ListensAtEveryAddressOfAName) {
    const int port = two_free_ports().first;
    TcpListener listener({"localhost", port, true}, "the test", 8);
    for (const SocketAddress& address : resolve_all("localhost", port, "the test")) {
        if (address.family() == AF_INET6 && !has_ipv6(two_free_ports().first)) continue;
        const UniqueFd caller(::socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC, 0));
        EXPECT_EQ(::connect(caller.get(), address.get(), address.size), 0) << address.text();
    }
}

TEST(TcpListener, ListensAtBothAddressesOfAName) {
    const int port = two_free_ports().first;
    TcpListener listener({name_of_two_addresses, port, true}, "the test", 8);
    for (const SocketAddress& address : resolve_all(name_of_two_addresses, port, "the test")) {
        if (address.family() == AF_INET6 && !has_ipv6(two_free_ports().first)) continue;
        const UniqueFd caller(::socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC, 0));
        EXPECT_EQ(::connect(caller.get(), address.get(), address.size), 0) << address.text();
    }
}

}  // namespace
}  // namespace vantage
