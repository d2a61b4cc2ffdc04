#include "common/receive/stage_receiver.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>
#include <zmq.hpp>

#include "common/base/bounded_queue.h"
#include "common/base/error.h"
#include "common/base/files/descriptor_limit.h"
#include "common/base/log.h"
#include "common/base/log_limiter.h"
#include "common/base/refused_inputs.h"
#include "common/base/this_thread.h"
#include "common/base/time/kernel_clock.h"
#include "common/base/time/time.h"
#include "common/base/trace/trace.h"
#include "common/config/endpoint.h"
#include "common/receive/frame_set_assembler.h"
#include "common/receive/outage_counter.h"
#include "common/receive/reachability.h"
#include "common/receive/rig_link.h"
#include "common/receive/take_starter.h"
#include "common/wire/curve_keys.h"
#include "common/wire/frame_codec.h"
#include "common/wire/limits.h"
#include "common/wire/random_id.h"
#include "common/wire/wake_event.h"
#include "common/wire/zmq_helpers.h"

namespace vantage {
namespace {

/// Closed frame sets that wait for next(). A program that draws slower than the stage's rate takes
/// the newest of these.
constexpr std::size_t max_closed_sets = 4;

/// ZeroMQ reads and decrypts on threads of its own; a single one would limit a large stage
/// (docs/results/scale.md).
constexpr std::size_t rigs_a_network_thread = 8;

/// Open files that a host needs: for each rig the sockets of ZeroMQ and their monitors, and for
/// everything else.
constexpr std::size_t descriptors_a_rig = 8, descriptors_of_a_host = 48;

/// Checks the limit of open files before ZeroMQ starts, which aborts if it cannot open its own.
int network_threads(const StageConfig& stage) {
    require_descriptors(descriptors_of_a_host + descriptors_a_rig * stage.rigs.size(),
                        fmt::format("a stage of {} rigs", stage.rigs.size()));
    return static_cast<int>(1 + stage.rigs.size() / rigs_a_network_thread);
}

/// When a disconnected rig is probed first, and how often after that.
constexpr std::chrono::milliseconds first_probe_after{300};
constexpr std::chrono::milliseconds probe_period{2000};
constexpr std::chrono::milliseconds probe_limit{1000};

/// A frame that arrives earlier than this after it was sent shows that two clocks differ.
constexpr std::chrono::nanoseconds clocks_differ = -std::chrono::seconds(1);

/// The shortest time between two log lines about a rig's invalid messages.
constexpr std::chrono::seconds complaint_period{10};

std::vector<std::string> names_of(const StageConfig& stage) {
    if (stage.rigs.empty()) fail("the stage has no rigs; add a [[rig]] with name and endpoint");
    std::vector<std::string> names;
    for (const StageConfig::Rig& rig : stage.rigs) {
        if (std::find(names.begin(), names.end(), rig.name) != names.end())
            fail("the stage has two rigs named {}", rig.name);
        names.push_back(rig.name);
    }
    return names;
}

FrameSetAssembler::Options assembler_options(const StageConfig& stage) {
    constexpr double ns_per_s = 1e9;
    constexpr double ns_per_ms = 1e6;
    if (!(stage.rate_hz > 0)) fail("rate_hz = {} has to be above 0", stage.rate_hz);
    if (!(stage.latency_budget_ms > 0))
        fail("latency_budget_ms = {} has to be above 0", stage.latency_budget_ms);
    return {
        std::chrono::nanoseconds(static_cast<std::int64_t>(ns_per_s / stage.rate_hz)),
        std::chrono::nanoseconds(static_cast<std::int64_t>(ns_per_ms * stage.latency_budget_ms))};
}

}  // namespace

struct StageReceiver::Impl {
    /// One rig: its link on the I/O thread, and its decoder on a thread of its own, so that its
    /// frames keep their order.
    struct Rig {
        Rig(zmq::context_t& context, const StageConfig::Rig& config,
            const std::optional<CurveKeys>& keys)
            : name(config.name),
              endpoint(parse_endpoint(config.endpoint, "endpoint")),
              link(context, config, keys),
              inbox(RigLink::credit_window) {
            status.rig = name;
            status.endpoint = config.endpoint;
            status.same_clock = endpoint.loopback;
        }
        const std::string name;
        const Endpoint endpoint;
        RigLink link;
        BoundedQueue<RigLink::Delivery> inbox;
        std::atomic<std::uint64_t> unhandled = 0;
        std::atomic<bool> is_decoded = true;
        std::thread decoder;

        // Used by the decoder's thread only: the newest right image, and the session it is from.
        SharedBytes right_jpeg;
        std::uint64_t session = 0;

        // Guarded by Impl::mutex.
        RigStatus status;
        bool relay_answers = false;     ///< a relay answers for the rig, with its reason
        std::string answering_address;  ///< of its host name, as a probe found; empty: none yet
        std::uint64_t undecodable_frames = 0;
        RigLink::Request request;
        std::shared_ptr<const std::string> report;
        OutageCounter outages;
        LogLimiter complaints{complaint_period};
        PercentileRecorder latency_ms, network_ms, decode_ms;
    };

    Impl(const StageConfig& stage, Purpose why, FrameTap frame_tap)
        : purpose(why),
          tap(std::move(frame_tap)),
          context(network_threads(stage)),
          assembler(names_of(stage), assembler_options(stage)),
          starter(PulseGrid(stage.rate_hz)),
          closed_frame_sets(max_closed_sets) {
        std::optional<CurveKeys> keys;
        if (!stage.key_file.empty()) keys = load_key_file(stage.key_file);
        for (const StageConfig::Rig& rig : stage.rigs)
            rigs.push_back(std::make_unique<Rig>(context, rig, keys));
        for (const auto& rig : rigs) {
            rig->request.streaming = films();
            rig->request.raw_pairs = purpose == Purpose::calibrate;
            rig->status.stage_rate_hz = stage.rate_hz;
        }
        for (std::size_t i = 0; i < rigs.size(); ++i)
            rigs[i]->decoder = std::thread([this, i] { decode_all(i); });
        io_thread = std::thread([this] { run(); });
    }

    ~Impl() {
        stopping = true;
        wake.notify();
        io_thread.join();
        for (const auto& rig : rigs) rig->inbox.close();
        for (const auto& rig : rigs) rig->decoder.join();
    }

    Rig& named(std::string_view name) {
        const auto rig = std::find_if(rigs.begin(), rigs.end(),
                                      [&](const auto& each) { return each->name == name; });
        if (rig == rigs.end()) fail("the stage has no rig named {}", name);
        return **rig;
    }

    void run() {
        name_this_thread("receive");
        try {
            while (!stopping) turn();
        } catch (const std::exception& error) {
            log_error("receiving ended: {}", error.what());
            const std::lock_guard lock(mutex);
            failure = error.what();
        }
    }

    void turn() {
        std::vector<zmq::pollitem_t> items{{nullptr, wake.fd(), ZMQ_POLLIN, 0}};
        for (const auto& rig : rigs) {
            items.push_back({rig->link.socket().handle(), 0, ZMQ_POLLIN, 0});
            items.push_back({rig->link.monitor().handle(), 0, ZMQ_POLLIN, 0});
        }
        wait_for(items, next_wait());
        wake.clear();
        const MonotonicTime now = MonotonicClock::now();
        for (std::size_t number = 0; number < rigs.size(); ++number) {
            const auto& rig = rigs[number];
            rig->link.watch(now);
            // One frame at a time, so that a rig that floods this host does not delay the others.
            if (std::optional<RigLink::Delivery> delivery = rig->link.receive(now)) {
                TraceSpan span("receive");
                span.in(TraceId::of_rig_frame(number, delivery->message.counters.sent),
                        TraceFlow::begins);
                if (tap)
                    tap({number, delivery->frame, delivery->message.counters, delivery->arrival,
                         delivery->arrival_tai});
                hand_over(*rig, std::move(*delivery));
            }
            RigLink::Request request;
            std::string other_address;
            {
                const std::lock_guard lock(mutex);
                request = rig->request;
                if (!rig->status.connected) other_address = rig->answering_address;
            }
            if (!other_address.empty()) rig->link.use_address(other_address);
            request.unhandled = rig->unhandled;
            request.first_pulse = first_pulse;
            rig->link.tick(request, now);
        }
        const std::lock_guard lock(mutex);
        for (std::size_t i = 0; i < rigs.size(); ++i) {
            Rig& rig = *rigs[i];
            show(rig, rig.link.view(now), now);
            // Frames that arrived before the rig disconnected still join their frame sets.
            assembler.set_connected(i, rig.status.connected || rig.unhandled > 0);
            assembler.set_at_stage_rate(i, rate_warning(rig.status).empty());
            assembler.set_asked(i, rig.request.streaming ? rig.request.rate_divisor : 0);
            note_step(rig, i);
        }
        collect_closed(now);
        start_take(now);
    }

    /// Precondition: mutex is held.
    void note_step(Rig& rig, std::size_t number) const {
        RigStatus& status = rig.status;
        const bool was_wrong = status.is_out_of_step || status.lags || status.names_no_pulse;
        status.is_out_of_step = assembler.is_out_of_step(number);
        status.lags = assembler.lags(number);
        status.names_no_pulse = assembler.names_no_pulse(number);
        const bool is_wrong = status.is_out_of_step || status.lags || status.names_no_pulse;
        if (is_wrong && !was_wrong)
            log_warning("rig {}: {}", rig.status.rig, trouble_of(rig.status));
        else if (was_wrong && !is_wrong)
            log_info("rig {} is in step again", rig.status.rig);
    }

    /// Precondition: mutex is held.
    void start_take(MonotonicTime now) {
        if (!films()) return;
        std::vector<TakeStarter::Rig> all;
        for (const auto& rig : rigs) all.push_back({rig->status.connected, rig->status.sync});
        const auto first = starter.update(all, TaiClock::now(), now);
        for (const std::size_t late : starter.laggards(all, now))
            log_warning("rig {} is not ready; it will join when it is", rigs[late]->name);
        if (!first || first_pulse != 0) return;
        first_pulse = *first;
        log_info("the stage's first pulse is {}", first_pulse);
    }

    std::chrono::nanoseconds next_wait() {
        std::chrono::nanoseconds wait = heartbeat_period;
        const std::lock_guard lock(mutex);
        if (const auto deadline = assembler.next_deadline())
            wait = std::min(wait, *deadline - MonotonicClock::now());
        return wait;
    }

    bool is_unexplained(const Rig& rig) const {
        const std::lock_guard lock(mutex);
        return !rig.status.connected && rig.status.refused.empty() && !rig.relay_answers;
    }

    /// Diagnoses why a rig is not connected.
    void probe(Rig& rig) {
        auto [address, reason] = reach(rig.endpoint, probe_limit);
        if (reason.empty())
            reason = fmt::format(
                "something at {} accepts connections but does not speak Vantage's protocol: the "
                "rig or this host is stopped or busy, or another program has the port",
                rig.endpoint.text());
        const std::lock_guard lock(mutex);
        if (!address.empty()) rig.answering_address = std::move(address);
        if (!rig.status.connected && !rig.relay_answers) rig.status.unreachable = std::move(reason);
    }

    void hand_over(Rig& rig, RigLink::Delivery delivery) {
        ++rig.unhandled;
        if (rig.inbox.push(std::move(delivery))) {
            --rig.unhandled;
            const std::lock_guard lock(mutex);
            ++rig.status.queue_dropped;
        }
    }

    void decode_all(std::size_t number) {
        name_this_thread("decode");
        Rig& rig = *rigs[number];
        FrameDecoder decoder;
        std::chrono::milliseconds patience = first_probe_after;
        // On another thread, so that a rig that returns meanwhile does not wait for a name lookup.
        std::future<void> probing;
        while (true) {
            const std::optional<RigLink::Delivery> delivery = rig.inbox.pop_for(patience);
            if (!delivery && rig.inbox.closed()) return;
            patience = probe_period;
            if (!delivery) {
                const bool is_free =
                    !probing.valid() ||
                    probing.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
                if (is_free && is_unexplained(rig))
                    probing = std::async(std::launch::async, [this, &rig] { probe(rig); });
                continue;
            }
            try {
                decode(number, decoder, *delivery);
            } catch (const std::exception& error) {
                note_refused_input("frame", delivery->frame->header, error.what());
                const std::lock_guard lock(mutex);
                ++rig.undecodable_frames;
                rig.status.last_error = error.what();
            }
            --rig.unhandled;
            wake.notify();
        }
    }

    void decode(std::size_t number, FrameDecoder& decoder, const RigLink::Delivery& delivery) {
        Rig& rig = *rigs[number];
        TraceSpan span("decode");
        span.in(TraceId::of_rig_frame(number, delivery.message.counters.sent), TraceFlow::ends);
        const MonotonicTime start = MonotonicClock::now();
        const PackedFrame& packed = *delivery.frame;
        auto frame = std::make_shared<RigFrame>(
            rig.is_decoded ? decoder.decode(packed.header, packed.colour, packed.disparity)
                           : decode_frame_head(packed.header).frame);
        frame->packed = delivery.frame;
        if (frame->rig != delivery.message.rig || frame->session != delivery.message.session)
            fail("a frame of rig {} came over the link of rig {}", frame->rig,
                 delivery.message.rig);
        const MonotonicTime end = MonotonicClock::now();
        const TaiTime decoded = TaiClock::now();

        // The right image comes occasionally; a consumer that takes only some frames needs it, too.
        if (!frame->right_jpeg && frame->session == rig.session) frame->right_jpeg = rig.right_jpeg;
        rig.right_jpeg = frame->right_jpeg;
        rig.session = frame->session;
        const std::lock_guard lock(mutex);
        rig.decode_ms.add(to_ms(end - start));
        if (delivery.arrival_tai - frame->published > clocks_differ)
            rig.network_ms.add(to_ms(delivery.arrival_tai - frame->published));
        if (decoded - frame->exposure > clocks_differ)
            rig.latency_ms.add(to_ms(decoded - frame->exposure));
        rig.status.rig_times = frame->times;
        ++rig.status.received;
        switch (assembler.add(number, std::move(frame), delivery.arrival)) {
            case FrameFate::in_frame_set:
                break;
            case FrameFate::late:
                ++rig.status.late;
                break;
            case FrameFate::duplicate:
                ++rig.status.duplicate;
                break;
            case FrameFate::unsynchronized:
                ++rig.status.unsynchronized;
                break;
            case FrameFate::out_of_step:
                ++rig.status.out_of_step;
                break;
        }
        collect_closed(end);
    }

    /// Precondition: mutex is held.
    void collect_closed(MonotonicTime now) {
        for (FrameSet& set : assembler.take_closed(now)) {
            TraceSpan span("frame set");
            span.with("rigs", set.present())
                .in(TraceId::of_frame_set(set.trigger_index), TraceFlow::begins);
            for (std::size_t i = 0; i < rigs.size(); ++i)
                rigs[i]->status.in_frame_sets += set.slots[i].frame != nullptr;
            ++sets;
            complete_frame_sets += set.present() == static_cast<int>(rigs.size());
            newest_frame_set = now;
            if (const std::optional<FrameSet> dropped = closed_frame_sets.push(std::move(set)))
                for (std::size_t i = 0; i < rigs.size(); ++i)
                    rigs[i]->status.in_dropped_frame_sets += dropped->slots[i].frame != nullptr;
        }
    }

    bool films() const { return purpose == Purpose::film || purpose == Purpose::calibrate; }

    /// Precondition: mutex is held.
    void show(Rig& rig, RigLink::View view, MonotonicTime now) const {
        const bool warns = purpose != Purpose::report;
        RigStatus& status = rig.status;
        const bool goes_on = status.connected && view.restarts == status.restarts;
        if (view.connected != status.connected)
            log_info("rig {} is {}", rig.name, view.connected ? "connected" : "gone");
        rig.relay_answers = view.refusal_passes && !view.refused.empty();
        if (view.connected) status.unreachable.clear();
        if (rig.relay_answers) {
            if (warns && view.refused != status.unreachable) log_info("{}", view.refused);
            status.unreachable = std::exchange(view.refused, {});
        }
        if (warns && !view.refused.empty() && view.refused != status.refused)
            log_warning("{}", view.refused);
        rig.outages.note(view.connected, view.heard);
        status.outages = rig.outages.outages();
        status.outage_s = std::chrono::duration<double>(rig.outages.length(now)).count();
        status.restarts = view.restarts;
        const std::string rate_before = rate_warning(status);
        const bool had_tai_warning = status.connected && !tai_warning(status).empty();
        if (goes_on && view.sync.clock_steps > status.sync.clock_steps)
            log_warning(
                "rig {}: {}; its frames are, or were, off the other rigs' by as much: check that "
                "its "
                "clock follows the stage's, and verify the timing by light (vantage-calib sync)",
                rig.name, clock_step_text(view.sync));
        status.connected = view.connected;
        status.refused = std::move(view.refused);
        status.lost = view.lost;
        status.link = view.link;
        status.rig_counters = view.rig_counters;
        status.since_start = view.since_start;
        status.sync = std::move(view.sync);
        status.own_tai_offset_s = read_kernel_clock().tai_offset_s;
        status.health = std::move(view.health);
        const std::string tai = status.connected ? tai_warning(status) : "";
        if (warns && !had_tai_warning && !tai.empty())
            log_warning(
                "rig {}: {}; until then latencies are unknown and its frames may miss their frame "
                "sets",
                rig.name, tai);
        if (!view.last_error.empty()) status.last_error = std::move(view.last_error);
        if (const std::string rate = rate_warning(status);
            warns && rate != rate_before && !rate.empty())
            log_warning("rig {}: {}", rig.name, rate);
        rig.report = std::move(view.report);
        complain(rig, rig.undecodable_frames + view.malformed, now);
    }

    /// Precondition: mutex is held.
    static void complain(Rig& rig, std::uint64_t undecodable, MonotonicTime now) {
        const std::uint64_t more = undecodable - std::exchange(rig.status.undecodable, undecodable);
        if (const auto times = rig.complaints.count(more, now))
            log_warning("invalid messages of rig {} at {}: {}; the last fault: {}", rig.name,
                        rig.status.endpoint, *times, rig.status.last_error);
    }

    const Purpose purpose;
    const FrameTap tap;
    zmq::context_t context;
    std::vector<std::unique_ptr<Rig>> rigs;

    mutable std::mutex mutex;  ///< guards the members below and the rigs' status; never held
                               ///< during a socket call or a decode
    FrameSetAssembler assembler;
    TakeStarter starter;
    std::uint64_t first_pulse = 0;  ///< 0: not announced yet; used by the I/O thread only
    std::uint64_t sets = 0;
    std::uint64_t complete_frame_sets = 0;
    std::optional<MonotonicTime> newest_frame_set;
    std::string failure;

    BoundedQueue<FrameSet> closed_frame_sets;
    WakeEvent wake;
    std::atomic<bool> stopping = false;
    std::thread io_thread;
};

StageReceiver::StageReceiver(const StageConfig& stage, Purpose purpose, FrameTap tap)
    : impl_(std::make_unique<Impl>(stage, purpose, std::move(tap))) {}

StageReceiver::~StageReceiver() = default;

std::optional<FrameSet> StageReceiver::next(std::chrono::nanoseconds timeout) {
    std::optional<FrameSet> set = impl_->closed_frame_sets.pop_for(timeout);
    if (!set) {
        const std::lock_guard lock(impl_->mutex);
        if (!impl_->failure.empty()) fail("receiving ended: {}", impl_->failure);
    }
    return set;
}

ReceiverStatus StageReceiver::status() const {
    const std::lock_guard lock(impl_->mutex);
    ReceiverStatus status;
    for (const auto& rig : impl_->rigs) {
        RigStatus& shown = status.rigs.emplace_back(rig->status);
        shown.latency_ms = rig->latency_ms.summary();
        shown.network_ms = rig->network_ms.summary();
        shown.decode_ms = rig->decode_ms.summary();
    }
    status.sets = impl_->sets;
    status.complete_frame_sets = impl_->complete_frame_sets;
    status.newest_frame_set = impl_->newest_frame_set;
    status.frame_sets_dropped = impl_->closed_frame_sets.dropped_count();
    return status;
}

void StageReceiver::ask(std::string_view rig_name, bool streaming, std::uint32_t rate_divisor) {
    if (rate_divisor < 1 || rate_divisor > max_rate_divisor)
        fail("a rate divisor of {} is outside 1..{}", rate_divisor, max_rate_divisor);
    Impl::Rig& rig = impl_->named(rig_name);
    {
        const std::lock_guard lock(impl_->mutex);
        rig.request.streaming = streaming;
        rig.request.rate_divisor = rate_divisor;
    }
    impl_->wake.notify();
}

void StageReceiver::set_decoded(std::string_view rig_name, bool is_decoded) {
    impl_->named(rig_name).is_decoded = is_decoded;
}

void StageReceiver::ask_for_reports() {
    {
        const std::lock_guard lock(impl_->mutex);
        for (const auto& rig : impl_->rigs) rig->request.report_id = random_id();
    }
    impl_->wake.notify();
}

std::shared_ptr<const std::string> StageReceiver::report_of(std::size_t rig) const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->rigs.at(rig)->report;
}

}  // namespace vantage
