#include "rig_firmware/pairing/service_announcement.h"

#include <cstdint>
#include <utility>

#include <avahi-client/client.h>
#include <avahi-client/publish.h>
#include <avahi-common/alternative.h>
#include <avahi-common/error.h>
#include <avahi-common/malloc.h>
#include <avahi-common/thread-watch.h>

#include "common/base/log.h"

namespace vantage {

/// All but the constructor and the destructor runs on Avahi's own thread.
struct ServiceAnnouncement::Impl {
    std::string name, type;
    int port = 0;
    AvahiThreadedPoll* poll = nullptr;
    AvahiClient* client = nullptr;
    AvahiEntryGroup* group = nullptr;
    bool has_complained = false;

    void start() {
        poll = avahi_threaded_poll_new();
        if (!poll) return complain("out of memory");
        connect();
        avahi_threaded_poll_start(poll);
    }

    void connect() {
        int error = 0;
        // Avahi may come later.
        client = avahi_client_new(avahi_threaded_poll_get(poll), AVAHI_CLIENT_NO_FAIL, on_client,
                                  this, &error);
        if (!client) complain(avahi_strerror(error));
    }

    /// Avahi was ended: what was announced is gone with it, and only a new client sees it come
    /// back.
    void connect_again(AvahiClient* lost) {
        client = nullptr;
        group = nullptr;
        avahi_client_free(lost);
        connect();
    }

    ~Impl() {
        if (poll) avahi_threaded_poll_stop(poll);
        // Its group goes with it, and the network is told.
        if (client) avahi_client_free(client);
        if (poll) avahi_threaded_poll_free(poll);
    }

    void complain(const char* why) {
        if (!std::exchange(has_complained, true))
            log_warning("{} is not announced to the network: {}; hosts find it by its address",
                        type, why);
    }

    static void on_client(AvahiClient* client, AvahiClientState state, void* self) {
        Impl& impl = *static_cast<Impl*>(self);
        switch (state) {
            case AVAHI_CLIENT_S_RUNNING:
                impl.announce(client);
                break;
            case AVAHI_CLIENT_S_COLLISION:
            case AVAHI_CLIENT_S_REGISTERING:
                if (impl.group) avahi_entry_group_reset(impl.group);
                break;
            case AVAHI_CLIENT_CONNECTING:
                impl.complain("no avahi-daemon runs on this computer");
                break;
            case AVAHI_CLIENT_FAILURE:
                if (client == impl.client && avahi_client_errno(client) == AVAHI_ERR_DISCONNECTED)
                    return impl.connect_again(client);
                impl.complain(avahi_strerror(avahi_client_errno(client)));
                break;
        }
    }

    static void on_group(AvahiEntryGroup* group, AvahiEntryGroupState state, void* self) {
        Impl& impl = *static_cast<Impl*>(self);
        if (state == AVAHI_ENTRY_GROUP_COLLISION) {
            impl.take_another_name();
            impl.announce(avahi_entry_group_get_client(group));
        } else if (state == AVAHI_ENTRY_GROUP_FAILURE) {
            impl.complain(avahi_strerror(avahi_client_errno(avahi_entry_group_get_client(group))));
        }
    }

    void take_another_name() {
        char* other = avahi_alternative_service_name(name.c_str());
        name = other;
        avahi_free(other);
    }

    void announce(AvahiClient* running) {
        if (!group) group = avahi_entry_group_new(running, on_group, this);
        if (!group) return complain(avahi_strerror(avahi_client_errno(running)));
        int error = AVAHI_ERR_COLLISION;
        constexpr int most_names = 20;
        for (int i = 0; i < most_names && error == AVAHI_ERR_COLLISION; ++i) {
            avahi_entry_group_reset(group);
            error = avahi_entry_group_add_service(group, AVAHI_IF_UNSPEC, AVAHI_PROTO_UNSPEC, {},
                                                  name.c_str(), type.c_str(), nullptr, nullptr,
                                                  static_cast<std::uint16_t>(port), nullptr);
            if (error == AVAHI_ERR_COLLISION) take_another_name();
        }
        if (error >= 0) error = avahi_entry_group_commit(group);
        if (error < 0) complain(avahi_strerror(error));
    }
};

ServiceAnnouncement::ServiceAnnouncement(const std::string& name, const std::string& type, int port)
    : impl_(std::make_unique<Impl>()) {
    impl_->name = name;
    impl_->type = type;
    impl_->port = port;
    impl_->start();
}

ServiceAnnouncement::~ServiceAnnouncement() = default;

}  // namespace vantage
