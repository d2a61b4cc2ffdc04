#include "tests/faults/impaired_road.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr const char* host_address = "10.77.0.1";
constexpr std::size_t largest_packet = 65536;
constexpr int packets_per_turn = 64;

[[noreturn]] void cannot(const std::string& what) {
    fail("{} cannot be done: {}", what, std::strerror(errno));
}

/// Root may make namespaces; anybody else may who has a namespace of users first.
void become_root_of_a_namespace() {
    if (::geteuid() == 0) return;
    const uid_t user = ::geteuid();
    const gid_t group = ::getegid();
    if (::unshare(CLONE_NEWUSER) != 0) cannot("a namespace of users");
    std::ofstream("/proc/self/setgroups") << "deny";
    std::ofstream("/proc/self/uid_map") << fmt::format("0 {} 1", user);
    std::ofstream("/proc/self/gid_map") << fmt::format("0 {} 1", group);
}

UniqueFd this_place() {
    UniqueFd place(::open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC));
    if (!place) cannot("opening this thread's network");
    return place;
}

UniqueFd new_place() {
    if (::unshare(CLONE_NEWNET) != 0) cannot("a network of its own");
    return this_place();
}

void go_to(const UniqueFd& place) {
    if (::setns(place.get(), CLONE_NEWNET) != 0) cannot("going to another network");
}

void set_up(const UniqueFd& socket, ifreq& request) {
    if (::ioctl(socket.get(), SIOCGIFFLAGS, &request) != 0) cannot("asking a network device");
    request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP | IFF_RUNNING);
    if (::ioctl(socket.get(), SIOCSIFFLAGS, &request) != 0) cannot("a network device that is up");
}

void set_address(const UniqueFd& socket, ifreq& request, unsigned long what, const char* address) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    ::inet_pton(AF_INET, address, &place.sin_addr);
    std::memcpy(&request.ifr_addr, &place, sizeof place);
    if (::ioctl(socket.get(), what, &request) != 0) cannot("an address of a network device");
}

/// The end of the road in this thread's network.
UniqueFd open_end(const char* address, const char* other) {
    UniqueFd end(::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (!end) cannot("/dev/net/tun");
    ifreq request{};
    std::strncpy(request.ifr_name, "road", IFNAMSIZ - 1);
    request.ifr_flags = IFF_TUN | IFF_NO_PI;
    if (::ioctl(end.get(), TUNSETIFF, &request) != 0) cannot("a TUN device");
    const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (!socket) cannot("a socket");
    set_address(socket, request, SIOCSIFADDR, address);
    set_address(socket, request, SIOCSIFDSTADDR, other);
    // Nothing is lost but what is meant to be: longer than what TCP has under way.
    constexpr int packets_waiting = 10000;
    request.ifr_qlen = packets_waiting;
    if (::ioctl(socket.get(), SIOCSIFTXQLEN, &request) != 0)
        cannot("a longer queue of a TUN device");
    set_up(socket, request);
    ifreq loopback{};
    std::strncpy(loopback.ifr_name, "lo", IFNAMSIZ - 1);
    set_up(socket, loopback);
    return end;
}

bool is_nth(std::uint64_t number, unsigned every) { return every > 0 && number % every == 0; }

}  // namespace

std::string ImpairedRoad::reason_against() {
    // In a process of its own, which leaves nothing behind.
    const pid_t child = ::fork();
    if (child == 0) {
        try {
            become_root_of_a_namespace();
            (void)new_place();
            (void)open_end(host_address, rig_address);
            ::_exit(0);
        } catch (const Error&) {
            ::_exit(1);
        }
    }
    int state = 0;
    ::waitpid(child, &state, 0);
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0) return "";
    return "this computer lets nobody make network namespaces with TUN devices";
}

ImpairedRoad::ImpairedRoad() : wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    become_root_of_a_namespace();
    home_ = this_place();
    rig_place_ = new_place();
    ends_[1] = open_end(rig_address, host_address);
    host_place_ = new_place();
    ends_[0] = open_end(host_address, rig_address);
    carrier_ = std::thread([this] { carry(); });
}

ImpairedRoad::~ImpairedRoad() {
    stopping_ = true;
    (void)!::eventfd_write(wake_.get(), 1);
    carrier_.join();
    // Whoever is not root may not go back, and stays where nothing else is.
    (void)::setns(home_.get(), CLONE_NEWNET);
}

void ImpairedRoad::at_the_rigs(const std::function<void()>& work) const {
    go_to(rig_place_);
    try {
        work();
    } catch (...) {
        go_to(host_place_);
        throw;
    }
    go_to(host_place_);
}

void ImpairedRoad::impair(const RoadTrouble& to_rigs, const RoadTrouble& from_rigs) {
    const std::lock_guard lock(mutex_);
    troubles_ = {to_rigs, from_rigs};
}

ImpairedRoad::Counts ImpairedRoad::counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
}

void ImpairedRoad::carry() {
    while (!stopping_) {
        const Time now = std::chrono::steady_clock::now();
        Time next = now + std::chrono::seconds(1);
        for (const std::size_t i : {0, 1}) {
            deliver(ends_[1 - i].get(), ways_[i], now);
            if (!ways_[i].under_way.empty())
                next = std::min(next, ways_[i].under_way.begin()->first);
        }
        pollfd items[] = {
            {ends_[0].get(), POLLIN, 0}, {ends_[1].get(), POLLIN, 0}, {wake_.get(), POLLIN, 0}};
        const auto wait = std::chrono::ceil<std::chrono::milliseconds>(next - now);
        (void)::poll(items, std::size(items), static_cast<int>(wait.count()));
        for (const std::size_t i : {0, 1}) take_in(i);
    }
}

void ImpairedRoad::take_in(std::size_t end) {
    Way& way = ways_[end];
    std::array<std::byte, largest_packet> packet;
    for (int i = 0; i < packets_per_turn; ++i) {
        const ssize_t bytes = ::read(ends_[end].get(), packet.data(), packet.size());
        if (bytes <= 0) return;
        // The kernel's own talk of IPv6 is not what is counted.
        constexpr unsigned ipv4 = 4;
        if (std::to_integer<unsigned>(packet[0]) >> 4 != ipv4) continue;
        const std::lock_guard lock(mutex_);
        const std::uint64_t number = ++way.packets;
        ++counts_.came;
        counts_.bytes += static_cast<std::uint64_t>(bytes);
        constexpr std::size_t place_of_protocol = 9;
        const bool is_udp = std::to_integer<int>(packet[place_of_protocol]) == IPPROTO_UDP;
        const RoadTrouble& asked = troubles_[end];
        const RoadTrouble trouble = asked.only_udp && !is_udp ? RoadTrouble{} : asked;
        const bool is_in_run = trouble.lose_every > 0 && number >= trouble.lose_every &&
                               number % trouble.lose_every < trouble.lose_run;
        const bool is_too_large = trouble.lose_over_bytes > 0 &&
                                  static_cast<std::size_t>(bytes) > trouble.lose_over_bytes;
        if (trouble.is_down || is_in_run || is_too_large) {
            ++counts_.lost;
            continue;
        }
        std::vector<std::byte> copy(packet.data(), packet.data() + bytes);
        if (is_nth(number, trouble.corrupt_every)) {
            copy.back() ^= std::byte{0x55};
            ++counts_.corrupted;
        }
        Time time = std::chrono::steady_clock::now() + trouble.delay;
        if (is_nth(number, trouble.late_every)) {
            time += trouble.late_by;
            ++counts_.late;
        }
        if (is_nth(number, trouble.duplicate_every)) {
            way.under_way.emplace(time, copy);
            ++counts_.duplicated;
        }
        way.under_way.emplace(time, std::move(copy));
    }
}

void ImpairedRoad::deliver(int to, Way& way, Time now) const {
    while (!way.under_way.empty() && way.under_way.begin()->first <= now) {
        const std::vector<std::byte>& packet = way.under_way.begin()->second;
        (void)!::write(to, packet.data(), packet.size());
        way.under_way.erase(way.under_way.begin());
    }
}

}  // namespace vantage
