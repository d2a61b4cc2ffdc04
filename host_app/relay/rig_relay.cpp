#include "host_app/relay/rig_relay.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <zmq.hpp>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/time.h"
#include "common/config/endpoint.h"
#include "common/receive/rig_link.h"
#include "common/serve/frame_server.h"
#include "common/wire/curve_keys.h"
#include "common/wire/random_id.h"
#include "common/wire/wake_event.h"
#include "common/wire/zmq_helpers.h"

namespace vantage {
namespace {

/// How often the hosts' combined requests are sent to the rigs.
constexpr std::chrono::milliseconds request_period{50};
constexpr const char* option_name = "--listen";
constexpr int highest_port = 65535;

/// The relay's endpoint for each rig, in their order.
std::vector<std::string> endpoints_of(const StageConfig& stage, const std::string& listen) {
    const Endpoint first = parse_endpoint(listen, option_name);
    std::vector<std::string> all;
    for (std::size_t i = 0; i < stage.rigs.size(); ++i) {
        Endpoint own = first;
        if (own.port != "*") {
            const int port = std::stoi(first.port) + static_cast<int>(i);
            if (port > highest_port)
                fail("{} {} leaves no ports for {} rigs: the highest is {}", option_name, listen,
                     stage.rigs.size(), highest_port);
            own.port = std::to_string(port);
        }
        all.push_back(own.text());
    }
    return all;
}

void require_keys(const StageConfig& stage, const RigRelay::Settings& settings) {
    if (settings.authorized_hosts.empty() && !parse_endpoint(settings.listen, option_name).loopback)
        fail(
            "{} {} can be reached from other computers, which needs keys: list the hosts with "
            "--authorized-hosts, or listen at 127.0.0.1",
            option_name, settings.listen);
    if (!settings.authorized_hosts.empty() && stage.key_file.empty())
        fail(
            "--authorized-hosts needs a key that hosts know this relay by: set key_file of the "
            "stage (make one with: vantage keys new FILE)");
}

}  // namespace

struct RigRelay::Impl {
    struct Relayed {
        Relayed(zmq::context_t& context, const StageConfig::Rig& config,
                const std::optional<CurveKeys>& keys, const FrameServer::Settings& settings)
            : name(config.name),
              link(context, config, keys),
              server(settings, config.name, random_id()) {
            server.change([&](HostLinks& links) {
                links.set_away(fmt::format("the relay has not reached rig {} yet", name));
                links.serve_views_only(
                    fmt::format("rig {} is reached through a relay, which does not forward raw "
                                "pairs; calibrate "
                                "with the rig's own endpoint",
                                name));
                links.serve_no_kept(
                    fmt::format("rig {} is reached through a relay, which does not forward rigs' "
                                "recordings; fetch "
                                "from the rig's own endpoint",
                                name));
            });
        }
        const std::string name;
        RigLink link;
        FrameServer server;
        std::uint64_t report_id = 0;
        std::shared_ptr<const std::string> report;  ///< the last forwarded one
        std::uint64_t dropped = 0, skipped = 0;     ///< already reported to hosts
        // Guarded by the mutex.
        Rig shown;
    };

    Impl(const StageConfig& stage, const Settings& settings) {
        if (stage.rigs.empty())
            fail("the stage has no rigs; add a [[rigs]] with name and endpoint");
        require_keys(stage, settings);
        std::set<std::string> names;
        for (const StageConfig::Rig& rig : stage.rigs)
            if (!names.insert(rig.name).second) fail("the stage has two rigs named {}", rig.name);
        std::optional<CurveKeys> keys;
        if (!stage.key_file.empty()) keys = load_key_file(stage.key_file);
        const std::vector<std::string> endpoints = endpoints_of(stage, settings.listen);
        const bool has_keys = !settings.authorized_hosts.empty();
        for (std::size_t i = 0; i < stage.rigs.size(); ++i) {
            rigs.push_back(std::make_unique<Relayed>(
                context, stage.rigs[i], keys,
                FrameServer::Settings{
                    endpoints[i], has_keys ? stage.key_file : std::filesystem::path(),
                    settings.authorized_hosts, settings.queue_frames, option_name}));
            Relayed& rig = *rigs.back();
            rig.shown.name = rig.name;
            rig.shown.endpoint = rig.server.endpoint();
            rig.shown.public_key = rig.server.public_key();
        }
        thread = std::thread([this] { run(); });
    }

    ~Impl() {
        stopping = true;
        wake.notify();
        thread.join();
    }

    void run() {
        try {
            while (!stopping) turn();
        } catch (const std::exception& error) {
            log_error("relaying ended: {}", error.what());
            const std::lock_guard lock(mutex);
            failure = error.what();
        }
    }

    void turn() {
        std::vector<zmq::pollitem_t> items{{nullptr, wake.fd(), ZMQ_POLLIN, 0}};
        for (const auto& rig : rigs) {
            items.push_back({rig->link.socket().handle(), 0, ZMQ_POLLIN, 0});
            items.push_back({rig->link.monitor().handle(), 0, ZMQ_POLLIN, 0});
            items.push_back({nullptr, rig->link.datagrams_fd(), ZMQ_POLLIN, 0});
        }
        wait_for(items, request_period);
        wake.clear();
        const MonotonicTime now = MonotonicClock::now();
        for (const auto& rig : rigs) turn(*rig, now);
    }

    /// Forwards one frame, so that a rig that floods the relay does not delay the others.
    void turn(Relayed& rig, MonotonicTime now) {
        rig.link.watch(now);
        const std::optional<RigLink::Delivery> delivery = rig.link.receive(now);
        const RigLink::View view = rig.link.view(now);
        pass_on(rig, delivery, view);
        tell_rig(rig, now);
        const std::lock_guard lock(mutex);
        if (delivery && delivery->frame) {
            ++rig.shown.frames;
            rig.shown.bytes += delivery->frame->bytes();
        }
        if (view.connected != rig.shown.connected)
            log_info("rig {} is {}", rig.name, view.connected ? "connected" : "gone");
        if (!view.refused.empty() && view.refused != rig.shown.trouble)
            log_warning("{}", view.refused);
        rig.shown.connected = view.connected;
        rig.shown.trouble = trouble_of(view);
        rig.shown.dropped = rig.dropped;
        rig.shown.undecodable = view.malformed;
    }

    static std::string trouble_of(const RigLink::View& view) {
        if (view.connected) return "";
        return view.refused.empty() ? view.last_error : view.refused;
    }

    void pass_on(Relayed& rig, const std::optional<RigLink::Delivery>& delivery,
                 const RigLink::View& view) {
        const std::uint64_t dropped = view.link.send_dropped + view.lost;
        const std::uint64_t missed = dropped - std::exchange(rig.dropped, dropped);
        const std::uint64_t skipped =
            view.link.skipped - std::exchange(rig.skipped, view.link.skipped);
        std::string away;
        if (!view.connected) {
            const std::string trouble = trouble_of(view);
            away = fmt::format("the relay does not reach rig {}{}{}", rig.name,
                               trouble.empty() ? "" : ": ", trouble);
        }
        rig.server.check();
        rig.server.change([&](HostLinks& links) {
            links.set_away(std::move(away));
            links.miss(missed, skipped);
            if (view.heard) links.relay(view.session, view.since_start, view.sync, view.health);
            if (delivery && delivery->frame) links.pass_on(delivery->frame);
            if (view.report != rig.report) links.reported(view.report);
        });
        rig.report = view.report;
        if (delivery || missed + skipped > 0) rig.server.wake();
    }

    void tell_rig(Relayed& rig, MonotonicTime now) {
        RigLink::Request request;
        bool wants_report = false;
        rig.server.change([&](const HostLinks& links) {
            const HostLinks::Demand demand = links.demand();
            request.streaming = demand.streaming;
            request.rate_divisor = demand.rate_divisor;
            wants_report = links.wants_report();
        });
        if (!wants_report) rig.report_id = 0;
        if (wants_report && rig.report_id == 0) rig.report_id = random_id();
        request.report_id = rig.report_id;
        request.first_pulse = rig.server.announced_pulse();
        rig.link.tick(request, now);
    }

    zmq::context_t context;
    std::vector<std::unique_ptr<Relayed>> rigs;
    mutable std::mutex mutex;
    std::string failure;
    WakeEvent wake;
    std::atomic<bool> stopping = false;
    std::thread thread;
};

RigRelay::RigRelay(const StageConfig& stage, const Settings& settings)
    : impl_(std::make_unique<Impl>(stage, settings)) {}

RigRelay::~RigRelay() = default;

std::vector<RigRelay::Rig> RigRelay::status() const {
    std::vector<Rig> all;
    {
        const std::lock_guard lock(impl_->mutex);
        if (!impl_->failure.empty()) fail("relaying ended: {}", impl_->failure);
        for (const auto& rig : impl_->rigs) all.push_back(rig->shown);
    }
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i].hosts =
            impl_->rigs[i]->server.change([](const HostLinks& links) { return links.hosts(); });
    return all;
}

}  // namespace vantage
