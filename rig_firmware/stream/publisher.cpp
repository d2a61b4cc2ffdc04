#include "rig_firmware/stream/publisher.h"

#include <atomic>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/descriptor_limit.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/config/endpoint.h"
#include "common/serve/frame_server.h"
#include "common/wire/random_id.h"

namespace vantage {
namespace {

/// Nice value of the thread that reads recorded frames for hosts.
constexpr int fetch_nice = 10;

/// File descriptors that a daemon opens after this point: ZeroMQ sockets for some hosts, the GPU,
/// cameras and files.
constexpr std::size_t descriptors_of_a_daemon = 48;

FrameServer::Settings settings_of(const RigConfig::Stream& config) {
    require_descriptors(descriptors_of_a_daemon, "a rig");
    if (config.key_file.empty() && !parse_endpoint(config.bind, "stream.bind").loopback)
        fail(
            "stream.bind = \"{}\" can be reached from other computers, which needs keys: set "
            "stream.key_file and stream.authorized_hosts, or bind to 127.0.0.1",
            config.bind);
    if (config.key_file.empty() != config.authorized_hosts.empty())
        fail("stream.key_file and stream.authorized_hosts are needed together; only {} is set",
             config.key_file.empty() ? "stream.authorized_hosts" : "stream.key_file");
    FrameServer::Settings settings{config.bind, config.key_file, config.authorized_hosts,
                                   config.queue_frames};
    settings.offers_datagrams = config.road == "srt";
    return settings;
}

}  // namespace

struct Publisher::Impl {
    Impl(const RigConfig::Stream& config, std::string name)
        : rig(std::move(name)),
          encoder(config.jpeg_quality, parse_chroma(config.chroma)),
          session(random_id()),
          server(settings_of(config), rig, session) {}

    ~Impl() {
        stopping = true;
        server.wake_waiting();
        if (fetch_thread.joinable()) fetch_thread.join();
        if (report_thread.joinable()) report_thread.join();
    }

    /// Serves fetch requests at low priority, after all other work of this computer.
    void look_up_kept() {
        name_this_thread("fetch");
        make_this_thread_nice(fetch_nice);
        while (!stopping) {
            std::optional<HostLinks::FetchJob> job;
            server.wait_for(heartbeat_period, [&](HostLinks& links) {
                return stopping || (job = links.next_fetch());
            });
            if (!job) continue;
            std::shared_ptr<const KeptParts> kept;
            std::string trouble;
            try {
                kept = kept_lookup(job->from_pulse, job->to_pulse);
            } catch (const std::exception& error) {
                trouble = fmt::format("rig {}: {}", rig, error.what());
                log_warning("{}", trouble);
            }
            server.tell([&](HostLinks& links) {
                links.fetched(*job, std::move(kept), std::move(trouble));
            });
        }
    }

    void make_reports() {
        name_this_thread("report");
        make_this_thread_nice(fetch_nice);
        while (!stopping) {
            bool is_wanted = false;
            server.wait_for(heartbeat_period, [&](HostLinks& links) {
                return stopping || (is_wanted = links.wants_report());
            });
            if (!is_wanted) continue;
            auto report = std::make_shared<const std::string>(make_report(stopping));
            server.tell([&](HostLinks& links) { links.reported(std::move(report)); });
        }
    }

    const std::string rig;
    FrameEncoder encoder;
    const std::uint64_t session;
    FrameServer server;
    std::atomic<bool> stopping = false;
    KeptLookup kept_lookup;
    ReportMaker make_report;
    std::thread fetch_thread, report_thread;
};

Publisher::Publisher(const RigConfig::Stream& config, std::string rig_name)
    : impl_(std::make_unique<Impl>(config, std::move(rig_name))) {}

Publisher::~Publisher() = default;

std::shared_ptr<const PackedFrame> Publisher::publish(RigFrame frame) {
    frame.rig = impl_->rig;
    frame.session = impl_->session;
    impl_->server.check();
    const bool is_raw_pair = frame.content == RigFrame::Content::raw_pair;
    const bool is_wanted = impl_->server.change([&](HostLinks& links) {
        links.set_rig_counters(frame.counters);
        if (is_raw_pair && !links.wants_raw_pair(frame.trigger_index)) {
            if (links.serves_raw_pairs_only()) links.pass_over();
            return false;
        }
        frame.counters = links.rig_counters();
        if (!is_raw_pair || links.serves_raw_pairs_only()) ++frame.counters.published;
        frame.sync = links.sync();
        return true;
    });
    if (!is_wanted) return nullptr;
    std::shared_ptr<const PackedFrame> packed;
    try {
        packed = std::make_shared<const PackedFrame>(impl_->encoder.encode(frame));
    } catch (const Error& error) {
        throw FrameRefused(error.what());
    }
    impl_->server.tell([&](HostLinks& links) { links.offer(packed); });
    return packed;
}

bool Publisher::wants_raw_pair(std::uint64_t trigger_index) const {
    return impl_->server.change(
        [&](const HostLinks& links) { return links.wants_raw_pair(trigger_index); });
}

void Publisher::serve_raw_pairs_only(std::string reason) {
    impl_->server.change([&](HostLinks& links) { links.serve_raw_pairs_only(std::move(reason)); });
}

void Publisher::serve_kept(KeptLookup lookup) {
    impl_->kept_lookup = std::move(lookup);
    impl_->server.change([](HostLinks& links) { links.serve_kept(); });
    impl_->fetch_thread = std::thread([this] { impl_->look_up_kept(); });
}

void Publisher::serve_reports(ReportMaker make) {
    impl_->make_report = std::move(make);
    impl_->report_thread = std::thread([this] { impl_->make_reports(); });
}

void Publisher::report(const RigCounters& counters) {
    impl_->server.change([&](HostLinks& links) { links.set_rig_counters(counters); });
}

void Publisher::report(const RigSync& sync) {
    impl_->server.change([&](HostLinks& links) { links.set_sync(sync); });
}

void Publisher::report(const RigHealth& health) {
    impl_->server.change([&](HostLinks& links) { links.set_health(health); });
}

std::uint64_t Publisher::announced_pulse() const { return impl_->server.announced_pulse(); }

PublisherStatus Publisher::status() const {
    const std::uint64_t malformed = impl_->server.malformed();
    const std::uint64_t refused = impl_->server.refused_connections();
    return impl_->server.change([&](const HostLinks& links) {
        return PublisherStatus{links.rig_counters(), links.hosts(), malformed,
                               links.refused_fetches(), refused};
    });
}

std::uint64_t Publisher::session() const { return impl_->session; }
std::string Publisher::endpoint() const { return impl_->server.endpoint(); }
std::string Publisher::public_key() const { return impl_->server.public_key(); }

}  // namespace vantage
