#include "host_app/setup/rig_browser.h"

#include <array>
#include <map>
#include <memory>
#include <string_view>

#include <avahi-client/client.h>
#include <avahi-client/lookup.h>
#include <avahi-common/error.h>
#include <avahi-common/simple-watch.h>

#include "common/base/error.h"
#include "common/base/time/time.h"
#include "common/pairing/pairing_place.h"

namespace vantage {
namespace {

struct FreePoll {
    void operator()(AvahiSimplePoll* poll) const { avahi_simple_poll_free(poll); }
};
/// Frees the client with its browsers and resolvers.
struct FreeClient {
    void operator()(AvahiClient* client) const { avahi_client_free(client); }
};

/// The rigs resolved so far, by name.
struct Found {
    std::map<std::string, FoundRig> rigs;

    void add(const char* name, std::string_view type, const AvahiAddress& address, int port) {
        std::array<char, AVAHI_ADDRESS_STR_MAX> text{};
        avahi_address_snprint(text.data(), text.size(), &address);
        FoundRig& rig = rigs[name];
        rig.name = name;
        const bool is_v6 = address.proto == AVAHI_PROTO_INET6;
        // IPv4 is preferred, since it is readable and needs no interface.
        if (rig.host.empty() || !is_v6)
            rig.host = is_v6 ? "[" + std::string(text.data()) + "]" : std::string(text.data());
        (type == pairing_service ? rig.pairing_port : rig.stream_port) = port;
    }
};

bool is_link_local(const AvahiAddress& address) {
    constexpr std::uint8_t first = 0xfe, second = 0x80, second_mask = 0xc0;
    return address.proto == AVAHI_PROTO_INET6 && address.data.ipv6.address[0] == first &&
           (address.data.ipv6.address[1] & second_mask) == second;
}

void on_resolved(AvahiServiceResolver* resolver, AvahiIfIndex, AvahiProtocol,
                 AvahiResolverEvent event, const char* name, const char* type, const char*,
                 const char*, const AvahiAddress* address, std::uint16_t port, AvahiStringList*,
                 AvahiLookupResultFlags, void* found) {
    // A link-local address is useless without its interface.
    if (event == AVAHI_RESOLVER_FOUND && !is_link_local(*address))
        static_cast<Found*>(found)->add(name, type, *address, port);
    avahi_service_resolver_free(resolver);
}

void on_browsed(AvahiServiceBrowser* browser, AvahiIfIndex interface, AvahiProtocol protocol,
                AvahiBrowserEvent event, const char* name, const char* type, const char* domain,
                AvahiLookupResultFlags, void* found) {
    if (event == AVAHI_BROWSER_NEW)
        avahi_service_resolver_new(avahi_service_browser_get_client(browser), interface, protocol,
                                   name, type, domain, AVAHI_PROTO_UNSPEC, {}, on_resolved, found);
}

void on_client(AvahiClient*, AvahiClientState, void*) {}

}  // namespace

std::vector<FoundRig> find_rigs(std::chrono::milliseconds time,
                                const std::function<bool()>& is_stopped) {
    Found found;
    const std::unique_ptr<AvahiSimplePoll, FreePoll> poll(avahi_simple_poll_new());
    int error = 0;
    const std::unique_ptr<AvahiClient, FreeClient> client(
        avahi_client_new(avahi_simple_poll_get(poll.get()), {}, on_client, nullptr, &error));
    if (!client)
        fail(
            "cannot browse for rigs ({}): install and start avahi-daemon, or give every rig with "
            "--rig HOST",
            avahi_strerror(error));
    for (const char* type : {pairing_service, stream_service})
        if (!avahi_service_browser_new(client.get(), AVAHI_IF_UNSPEC, AVAHI_PROTO_UNSPEC, type,
                                       nullptr, {}, on_browsed, &found))
            fail("avahi-daemon refuses to browse for rigs: {}",
                 avahi_strerror(avahi_client_errno(client.get())));
    constexpr int turn_ms = 50;
    const MonotonicTime end = MonotonicClock::now() + time;
    while (MonotonicClock::now() < end && !is_stopped())
        if (avahi_simple_poll_iterate(poll.get(), turn_ms) != 0) break;
    std::vector<FoundRig> rigs;
    for (auto& [name, rig] : found.rigs) rigs.push_back(std::move(rig));
    return rigs;
}

}  // namespace vantage
