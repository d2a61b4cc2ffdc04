#include "rig_firmware/stream/publisher.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <exception>
#include <iterator>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <zmq.hpp>
#include <zmq_addon.hpp>

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/log_limiter.h"
#include "common/config/endpoint.h"
#include "common/wire/curve_keys.h"
#include "common/wire/limits.h"
#include "common/wire/random_id.h"
#include "common/wire/wake_event.h"
#include "common/wire/zmq_helpers.h"
#include "rig_firmware/stream/host_admission.h"

namespace vantage {
namespace {

/// Credit bounds the frames on a connection; this only has to be above it with its heartbeats.
constexpr int send_high_water_mark = 4 * static_cast<int>(max_credit_window);
constexpr int receive_high_water_mark = 64;
/// A host that talks without end does not keep frames from leaving.
constexpr int messages_per_turn = 64;
constexpr std::chrono::seconds handshake_limit{5};
/// Between lines about messages that are no host's.
constexpr std::chrono::seconds complaint_period{10};
/// Of the thread that reads what hosts fetch.
constexpr int fetch_nice = 10;

/// The key a message came under, as HostAdmission let it in; empty without keys.
std::string host_key_of(zmq::message_t& part) { return property_of(part, "User-Id"); }

std::string address_of(zmq::message_t& part) {
    const std::string address = property_of(part, "Peer-Address");
    return address.empty() ? "an unknown address" : address;
}

}  // namespace

struct Publisher::Impl {
    Impl(const RigConfig::Stream& config, std::string name)
        : rig(std::move(name)),
          encoder(config.jpeg_quality),
          session(random_id()),
          links(rig, session, static_cast<std::size_t>(std::max(config.queue_frames, 1))),
          router(context, zmq::socket_type::router) {
        bind(config);
        io_thread = std::thread([this] { run(); });
    }

    ~Impl() {
        stopping = true;
        wake.notify();
        fetch_wanted.notify_all();
        io_thread.join();
        if (fetch_thread.joinable()) fetch_thread.join();
        if (report_thread.joinable()) report_thread.join();
    }

    void bind(const RigConfig::Stream& config) {
        const Endpoint wanted = parse_endpoint(config.bind, "stream.bind");
        if (config.key_file.empty() && !wanted.loopback)
            fail(
                "stream.bind = \"{}\" can be reached from other computers, which needs keys: set "
                "stream.key_file and stream.authorized_hosts, or bind to 127.0.0.1",
                config.bind);
        if (config.key_file.empty() != config.authorized_hosts.empty())
            fail("stream.key_file and stream.authorized_hosts are needed together; only {} is set",
                 config.key_file.empty() ? "stream.authorized_hosts" : "stream.key_file");
        router.set(zmq::sockopt::linger, 0);
        router.set(zmq::sockopt::router_mandatory, true);
        router.set(zmq::sockopt::sndhwm, send_high_water_mark);
        router.set(zmq::sockopt::rcvhwm, receive_high_water_mark);
        router.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(max_header_bytes));
        router.set(zmq::sockopt::handshake_ivl, option_ms(handshake_limit));
        watch_for_dead_connections(router);
        router.set(zmq::sockopt::ipv6, wanted.ipv6);
        if (!config.key_file.empty()) {
            const CurveKeys keys = load_key_file(config.key_file);
            public_key = keys.public_key;
            admission.emplace(context, config.authorized_hosts);
            router.set(zmq::sockopt::zap_domain, "vantage");
            router.set(zmq::sockopt::curve_server, true);
            router.set(zmq::sockopt::curve_secretkey, keys.secret_key);
        }
        try {
            router.bind(wanted.text());
        } catch (const zmq::error_t& error) {
            if (error.num() == EADDRINUSE)
                fail(
                    "port {} of {} is in use by another program; end it or choose another "
                    "stream.bind",
                    wanted.port, wanted.host);
            fail("stream.bind = \"{}\" cannot be bound: {}", config.bind, error.what());
        }
        endpoint = router.get(zmq::sockopt::last_endpoint);
    }

    void run() {
        try {
            while (!stopping) turn();
        } catch (const std::exception& error) {
            log_error("publishing of rig {} came to an end: {}", rig, error.what());
            const std::lock_guard lock(mutex);
            failure = error.what();
        }
    }

    void turn() {
        const MonotonicTime now = MonotonicClock::now();
        if (now >= next_heartbeat) {
            next_heartbeat = now + heartbeat_period;
            const std::lock_guard lock(mutex);
            links.expire(now);
            links.ring();
        }
        send_all();
        std::vector<zmq::pollitem_t> items{{nullptr, wake.fd(), ZMQ_POLLIN, 0},
                                           {router.handle(), 0, ZMQ_POLLIN, 0}};
        if (admission) items.push_back({admission->socket().handle(), 0, ZMQ_POLLIN, 0});
        wait_for(items, next_heartbeat - MonotonicClock::now());
        wake.clear();
        if (admission) admission->answer();
        for (int i = 0; i < messages_per_turn && receive(); ++i) {
        }
    }

    bool receive() {
        std::vector<zmq::message_t> parts;
        if (!zmq::recv_multipart(router, std::back_inserter(parts), zmq::recv_flags::dontwait))
            return false;
        if (parts.empty()) return true;
        const std::string route = parts.front().to_string();
        const MonotonicTime now = MonotonicClock::now();
        try {
            if (parts.size() != 2) fail("a host message of {} parts came", parts.size() - 1);
            const HostMessage message = decode_host_message(bytes_of(parts[1]));
            const std::lock_guard lock(mutex);
            links.hear(route, host_key_of(parts[1]), message, now);
            if (message.first_pulse != 0) announced_pulse = message.first_pulse;
            if (message.fetch || message.report_id != 0) fetch_wanted.notify_all();
        } catch (const Error& error) {
            if (const auto times = complaints.count(1, now))
                log_warning("messages that are no host's were refused: {}; the last, from {}: {}",
                            *times, address_of(parts.back()), error.what());
            const std::lock_guard lock(mutex);
            ++malformed;
            links.refuse(route, fmt::format("rig {}: {}", rig, error.what()));
        }
        return true;
    }

    void send_all() {
        std::vector<HostLinks::Outgoing> all;
        {
            const std::lock_guard lock(mutex);
            all = links.take();
        }
        std::vector<std::string> gone;
        for (const HostLinks::Outgoing& outgoing : all) {
            const bool was_gone = std::find(gone.begin(), gone.end(), outgoing.route) != gone.end();
            if (!was_gone && send(outgoing)) continue;
            gone.push_back(outgoing.route);
            const std::lock_guard lock(mutex);
            links.undelivered(outgoing);
        }
    }

    bool send(const HostLinks::Outgoing& outgoing) {
        const std::vector<std::byte> message = encode(outgoing.message);
        std::vector<std::span<const std::byte>> parts{std::as_bytes(std::span(outgoing.route)),
                                                      message};
        if (outgoing.frame) {
            parts.emplace_back(outgoing.frame->header);
            parts.emplace_back(outgoing.frame->colour);
            parts.emplace_back(outgoing.frame->disparity);
        }
        if (outgoing.report) parts.push_back(std::as_bytes(std::span(*outgoing.report)));
        if (outgoing.kept) {
            parts.emplace_back(outgoing.kept->head);
            parts.emplace_back(outgoing.kept->record);
            parts.emplace_back(outgoing.kept->colour);
            parts.emplace_back(outgoing.kept->depth);
        }
        try {
            for (std::size_t i = 0; i < parts.size(); ++i) {
                const auto more =
                    i + 1 < parts.size() ? zmq::send_flags::sndmore : zmq::send_flags::none;
                if (!router.send(zmq::buffer(parts[i].data(), parts[i].size()),
                                 more | zmq::send_flags::dontwait))
                    return false;
            }
            return true;
        } catch (const zmq::error_t& error) {
            if (error.num() == EHOSTUNREACH) return false;
            throw;
        }
    }

    /// What hosts fetch comes behind all else that this computer does.
    void look_up_kept() {
        ::pthread_setname_np(::pthread_self(), "fetch");
        ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), fetch_nice);
        while (!stopping) {
            std::optional<HostLinks::FetchJob> job;
            {
                std::unique_lock lock(mutex);
                fetch_wanted.wait_for(lock, heartbeat_period,
                                      [&] { return stopping || (job = links.next_fetch()); });
            }
            if (!job) continue;
            std::shared_ptr<const KeptParts> kept;
            std::string trouble;
            try {
                kept = kept_lookup(job->from_pulse, job->to_pulse);
            } catch (const std::exception& error) {
                trouble = fmt::format("rig {}: {}", rig, error.what());
                log_warning("{}", trouble);
            }
            {
                const std::lock_guard lock(mutex);
                links.fetched(*job, std::move(kept), std::move(trouble));
            }
            wake.notify();
        }
    }

    void make_reports() {
        ::pthread_setname_np(::pthread_self(), "report");
        ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), fetch_nice);
        while (!stopping) {
            bool is_wanted = false;
            {
                std::unique_lock lock(mutex);
                fetch_wanted.wait_for(lock, heartbeat_period, [&] {
                    return stopping || (is_wanted = links.wants_report());
                });
            }
            if (!is_wanted) continue;
            auto report = std::make_shared<const std::string>(make_report(stopping));
            {
                const std::lock_guard lock(mutex);
                links.reported(std::move(report));
            }
            wake.notify();
        }
    }

    const std::string rig;
    FrameEncoder encoder;
    const std::uint64_t session;
    std::string public_key;
    std::string endpoint;

    mutable std::mutex mutex;  ///< of links and failure; never held over a socket call
    HostLinks links;
    std::string failure;
    std::uint64_t malformed = 0;
    LogLimiter complaints{complaint_period};  ///< the I/O thread's
    std::atomic<std::uint64_t> announced_pulse = 0;

    zmq::context_t context;
    std::optional<HostAdmission> admission;
    zmq::socket_t router;
    WakeEvent wake;
    MonotonicTime next_heartbeat{};
    std::atomic<bool> stopping = false;
    KeptLookup kept_lookup;
    ReportMaker make_report;
    std::condition_variable fetch_wanted;  ///< or a report
    std::thread io_thread, fetch_thread, report_thread;
};

Publisher::Publisher(const RigConfig::Stream& config, std::string rig_name)
    : impl_(std::make_unique<Impl>(config, std::move(rig_name))) {}

Publisher::~Publisher() = default;

std::shared_ptr<const PackedFrame> Publisher::publish(RigFrame frame) {
    frame.rig = impl_->rig;
    frame.session = impl_->session;
    {
        const std::lock_guard lock(impl_->mutex);
        if (!impl_->failure.empty())
            fail("publishing of rig {} came to an end: {}", impl_->rig, impl_->failure);
        HostLinks& links = impl_->links;
        links.set_rig_counters(frame.counters);
        const bool is_raw_pair = frame.content == RigFrame::Content::raw_pair;
        if (is_raw_pair && !links.wants_raw_pair(frame.trigger_index)) {
            if (links.serves_raw_pairs_only()) links.pass_over();
            return nullptr;
        }
        frame.counters = links.rig_counters();
        if (!is_raw_pair || links.serves_raw_pairs_only()) ++frame.counters.published;
        frame.sync = links.sync();
    }
    auto packed = std::make_shared<const PackedFrame>(impl_->encoder.encode(frame));
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->links.offer(packed);
    }
    impl_->wake.notify();
    return packed;
}

bool Publisher::wants_raw_pair(std::uint64_t trigger_index) const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->links.wants_raw_pair(trigger_index);
}

void Publisher::serve_raw_pairs_only(std::string reason) {
    const std::lock_guard lock(impl_->mutex);
    impl_->links.serve_raw_pairs_only(std::move(reason));
}

void Publisher::serve_kept(KeptLookup lookup) {
    impl_->kept_lookup = std::move(lookup);
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->links.serve_kept();
    }
    impl_->fetch_thread = std::thread([this] { impl_->look_up_kept(); });
}

void Publisher::serve_reports(ReportMaker make) {
    impl_->make_report = std::move(make);
    impl_->report_thread = std::thread([this] { impl_->make_reports(); });
}

void Publisher::report(const RigCounters& counters) {
    const std::lock_guard lock(impl_->mutex);
    impl_->links.set_rig_counters(counters);
}

void Publisher::report(const RigSync& sync) {
    const std::lock_guard lock(impl_->mutex);
    impl_->links.set_sync(sync);
}

void Publisher::report(const RigHealth& health) {
    const std::lock_guard lock(impl_->mutex);
    impl_->links.set_health(health);
}

std::uint64_t Publisher::announced_pulse() const { return impl_->announced_pulse; }

PublisherStatus Publisher::status() const {
    const std::lock_guard lock(impl_->mutex);
    return {impl_->links.rig_counters(), impl_->links.hosts(), impl_->malformed,
            impl_->links.refused_fetches()};
}

std::uint64_t Publisher::session() const { return impl_->session; }
std::string Publisher::endpoint() const { return impl_->endpoint; }
std::string Publisher::public_key() const { return impl_->public_key; }

}  // namespace vantage
