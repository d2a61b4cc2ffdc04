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
#include "common/base/time/clock_step_watch.h"
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
constexpr std::size_t descriptors_a_rig = 12, descriptors_of_a_host = 48;

/// Checks the limit of open files before ZeroMQ starts, which aborts if it cannot open its own.
void require_descriptors_for(const StageConfig& stage) {
    require_descriptors(descriptors_of_a_host + descriptors_a_rig * stage.rigs.size(),
                        fmt::format("a stage of {} rigs", stage.rigs.size()));
}

int network_threads(const StageConfig& stage) {
    require_descriptors_for(stage);
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

struct StageReceiver::Update::Content {
    StageConfig stage;
    std::vector<std::string> names;
    std::optional<CurveKeys> host_keys;
    std::vector<std::size_t> numbers;             ///< of the stage's rigs
    std::vector<std::unique_ptr<RigLink>> links;  ///< null: the rig's link stays
};

struct StageReceiver::Impl {
    using StageUpdate = Update::Content;

    /// Log lines about a rig's state that may be written within a period. A rig whose state changes
    /// more often than this is faulty or hostile, and the log must not fill the disk.
    static constexpr int most_state_lines = 40;
    static constexpr std::chrono::seconds state_lines_period{10};

    /// Counts the log lines about a rig's state.
    struct StateLines {
        MonotonicTime began{};
        int written = 0;
        std::uint64_t left_out = 0;
    };

    /// One rig: its link on the I/O thread, and its decoder on a thread of its own, so that its
    /// frames keep their order.
    struct Rig {
        explicit Rig(std::string its_name) : name(std::move(its_name)) { status.rig = name; }
        const std::string name;
        std::atomic<std::uint64_t> unhandled = 0;
        std::atomic<bool> is_decoded = true;

        // Used by the I/O thread only.
        std::unique_ptr<RigLink> link;  ///< null: the rig is removed
        std::optional<RigLink::Continuity> former_link;
        /// Closed once the rig is removed; the decoder then ends when the queue is empty.
        std::shared_ptr<BoundedQueue<RigLink::Delivery>> inbox;
        std::future<void> decoder;

        // Guarded by Impl::mutex.
        StageConfig::Rig config;
        Endpoint endpoint;
        RigStatus status;
        bool relay_answers = false;     ///< a relay answers for the rig, with its reason
        std::string answering_address;  ///< of its host name, as a probe found; empty: none yet
        std::uint64_t undecodable_frames = 0;
        RigLink::Request request;
        std::shared_ptr<const std::string> report;
        std::optional<MonotonicTime> ready_since;
        std::optional<MonotonicTime> datagram_trouble_since;  ///< not logged yet
        OutageCounter outages;
        LogLimiter complaints{complaint_period};
        StateLines state_lines;
        PercentileRecorder latency_ms, network_ms, decode_ms;
    };

    /// Decodes a rig's frames, and remembers the newest right image. Used by the rig's decoding
    /// thread only.
    struct Decoder {
        FrameDecoder frames;
        SharedBytes right_jpeg;     ///< the newest right image
        std::uint64_t session = 0;  ///< that it is from
    };

    Impl(const StageConfig& stage, Purpose why, FrameTap frame_tap)
        : purpose(why),
          tap(std::move(frame_tap)),
          context(network_threads(stage)),
          assembler(names_of(stage), assembler_options(stage)),
          starter(PulseGrid(stage.rate_hz)),
          stage_rate_hz(stage.rate_hz),
          closed_frame_sets(max_closed_sets) {
        StageUpdate update = update_to(stage);
        note_newest(update);
        for (std::size_t number = 0; number < stage.rigs.size(); ++number)
            rigs.push_back(std::make_unique<Rig>(stage.rigs[number].name));
        for (std::size_t number = 0; number < stage.rigs.size(); ++number)
            join(number, stage.rigs[number], std::move(update.links[number]));
        io_thread = std::thread([this] { run(); });
    }

    ~Impl() {
        stopping = true;
        wake.notify();
        io_thread.join();
        for (const auto& rig : rigs) rig->inbox->close();
        for (const auto& rig : rigs) rig->decoder.wait();
    }

    /// Makes the links that a stage needs. Throws Error. Precondition: mutex is held, or there are
    /// no other threads.
    StageUpdate update_to(const StageConfig& stage) {
        require_descriptors_for(stage);
        (void)assembler_options(stage);
        StageUpdate update{stage, numbered_names, {}, {}, {}};
        for (const std::string& name : names_of(stage))
            if (std::find(numbered_names.begin(), numbered_names.end(), name) ==
                numbered_names.end())
                update.names.push_back(name);
        if (!stage.key_file.empty()) update.host_keys = load_key_file(stage.key_file);
        const auto key_of = [](const std::optional<CurveKeys>& pair) {
            return pair ? pair->public_key : std::string();
        };
        const bool has_new_key = key_of(update.host_keys) != key_of(host_keys);
        for (const StageConfig::Rig& rig : stage.rigs) {
            const auto before =
                std::find_if(connected.begin(), connected.end(),
                             [&](const StageConfig::Rig& other) { return other.name == rig.name; });
            const bool stays = before != connected.end() && before->endpoint == rig.endpoint &&
                               before->public_key == rig.public_key &&
                               (rig.public_key.empty() || !has_new_key);
            update.links.push_back(
                stays ? nullptr : std::make_unique<RigLink>(context, rig, update.host_keys));
            update.numbers.push_back(static_cast<std::size_t>(
                std::find(update.names.begin(), update.names.end(), rig.name) -
                update.names.begin()));
        }
        return update;
    }

    /// Makes an update the newest one. Precondition as of update_to().
    void note_newest(const StageUpdate& update) {
        numbered_names = update.names;
        connected = update.stage.rigs;
        host_keys = update.host_keys;
    }

    /// Connects a rig, or connects it in another way. On the I/O thread, or before it runs.
    void join(std::size_t number, const StageConfig::Rig& config, std::unique_ptr<RigLink> link) {
        Rig& rig = *rigs[number];
        if (rig.link) rig.former_link = rig.link->continuity();
        if (rig.former_link) link->continue_from(*rig.former_link);
        const bool is_new = !rig.link;
        rig.link = std::move(link);
        const std::lock_guard lock(mutex);
        rig.config = config;
        rig.endpoint = parse_endpoint(config.endpoint, "endpoint");
        rig.answering_address.clear();
        rig.status.endpoint = config.endpoint;
        rig.status.same_clock = rig.endpoint.loopback;
        rig.status.unreachable.clear();
        rig.status.is_removed = false;
        rig.status.stage_rate_hz = stage_rate_hz;
        if (!is_new) return;
        rig.request = {};
        rig.request.streaming = films();
        rig.request.raw_pairs = purpose == Purpose::calibrate;
        rig.is_decoded = true;
        if (rig.decoder.valid()) ended_decoders.push_back(std::move(rig.decoder));
        rig.inbox = std::make_shared<BoundedQueue<RigLink::Delivery>>(max_credit_window);
        rig.decoder = std::async(std::launch::async, [this, number, &rig, inbox = rig.inbox] {
            decode_all(number, rig, *inbox);
        });
    }

    /// Disconnects a rig. Frames that it has delivered still join their frame sets.
    void remove(Rig& rig) {
        rig.former_link = rig.link->continuity();
        rig.link.reset();
        rig.inbox->close();
        const std::lock_guard lock(mutex);
        rig.status.connected = false;
        rig.status.is_removed = true;
        rig.status.refused.clear();
        rig.status.unreachable.clear();
        rig.status.is_out_of_step = rig.status.lags = rig.status.names_no_pulse = false;
        rig.outages.leave(MonotonicClock::now());
        log_info("rig {} is removed from the stage", rig.name);
    }

    /// Applies an update on the I/O thread.
    void apply(StageUpdate update) {
        std::erase_if(ended_decoders, [](const std::future<void>& decoder) {
            return decoder.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
        });
        for (const StageConfig::Rig& config : update.stage.rigs) {
            const auto same_name = [&](const auto& rig) { return rig->name == config.name; };
            if (std::any_of(rigs.begin(), rigs.end(), same_name)) continue;
            const std::lock_guard lock(mutex);
            rigs.push_back(std::make_unique<Rig>(config.name));
            assembler.add_rig(config.name);
        }
        for (std::size_t number = 0; number < rigs.size(); ++number) {
            const bool stays = std::find(update.numbers.begin(), update.numbers.end(), number) !=
                               update.numbers.end();
            if (!stays && rigs[number]->link) remove(*rigs[number]);
        }
        for (std::size_t i = 0; i < update.numbers.size(); ++i)
            if (update.links[i])
                join(update.numbers[i], update.stage.rigs[i], std::move(update.links[i]));
        const std::lock_guard lock(mutex);
        assembler.set_order(update.numbers);
        assembler.set_latency_budget(assembler_options(update.stage).latency_budget);
    }

    /// Precondition: mutex is held.
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
            if (!rig->link) continue;
            items.push_back({rig->link->socket().handle(), 0, ZMQ_POLLIN, 0});
            items.push_back({rig->link->monitor().handle(), 0, ZMQ_POLLIN, 0});
            items.push_back({nullptr, rig->link->datagrams_fd(), ZMQ_POLLIN, 0});
        }
        wait_for(items, next_wait());
        wake.clear();
        std::vector<StageUpdate> changes;
        {
            const std::lock_guard lock(mutex);
            changes.swap(updates);
        }
        for (StageUpdate& change : changes) apply(std::move(change));
        watch_clock();
        const MonotonicTime now = MonotonicClock::now();
        for (std::size_t number = 0; number < rigs.size(); ++number) {
            const auto& rig = rigs[number];
            if (!rig->link) continue;
            rig->link->watch(now);
            // One frame at a time, so that a rig that floods this host does not delay the others.
            if (std::optional<RigLink::Delivery> delivery = rig->link->receive(now)) {
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
            if (!other_address.empty()) rig->link->use_address(other_address);
            request.unhandled = rig->unhandled;
            request.first_pulse = first_pulse;
            rig->link->tick(request, now);
        }
        const std::lock_guard lock(mutex);
        for (std::size_t i = 0; i < rigs.size(); ++i) {
            Rig& rig = *rigs[i];
            if (rig.link) show(rig, rig.link->view(now), now);
            // Frames that arrived before the rig disconnected still join their frame sets.
            assembler.set_connected(i, rig.status.connected || rig.unhandled > 0);
            assembler.set_coming(i, is_coming(rig, now));
            assembler.set_at_stage_rate(i, rate_warning(rig.status).empty());
            assembler.set_asked(i,
                                rig.link && rig.request.streaming ? rig.request.rate_divisor : 0);
            if (rig.link) note_step(rig, i);
        }
        collect_closed(now);
        start_take(now);
    }

    /// Whether the rig is about to send its first frames: it starts, or became ready a short time
    /// ago. Precondition: mutex is held.
    static bool is_coming(Rig& rig, MonotonicTime now) {
        const RigStatus& status = rig.status;
        if (!status.connected || !status.sync.ready)
            rig.ready_since.reset();
        else if (!rig.ready_since)
            rig.ready_since = now;
        return status.connected && rig.request.streaming &&
               (!status.health.starting.empty() ||
                (rig.ready_since && now - *rig.ready_since < TakeStarter::ready_patience));
    }

    /// Names a step of this computer's clock. Frame sets do not depend on that clock.
    void watch_clock() {
        const auto step = own_clock.look();
        if (step && purpose != Purpose::report)
            log_warning(
                "the clock of this computer was set by {:+.1f} ms: latencies and the times of "
                "takes are off by as much, and frames and ticks are not affected; let PTP or NTP "
                "adjust the clock slowly while a show runs",
                to_ms(*step));
    }

    /// Writes a log line about the rig's state, unless there were too many. Precondition: mutex is
    /// held.
    static void tell_state(Rig& rig, bool is_warning, const std::string& line) {
        StateLines& lines = rig.state_lines;
        const MonotonicTime now = MonotonicClock::now();
        if (lines.written == 0 || now - lines.began > state_lines_period) {
            if (lines.left_out > 0)
                log_warning("rig {}: {} further lines about its state were left out", rig.name,
                            lines.left_out);
            lines = {now, 0, 0};
        }
        if (lines.written == most_state_lines) {
            if (++lines.left_out == 1)
                log_warning(
                    "rig {}: its state changes all the time, and the log leaves the changes out; "
                    "look for a second rig of this name, or for a rig that was tampered with",
                    rig.name);
            return;
        }
        ++lines.written;
        is_warning ? log_warning("{}", line) : log_info("{}", line);
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
            tell_state(rig, true, fmt::format("rig {}: {}", rig.name, trouble_of(rig.status)));
        else if (was_wrong && !is_wrong)
            tell_state(rig, false, fmt::format("rig {} is in step again", rig.name));
    }

    /// Precondition: mutex is held.
    void start_take(MonotonicTime now) {
        if (!films()) return;
        std::vector<TakeStarter::Rig> all;
        std::vector<const Rig*> of_stage;
        for (const auto& rig : rigs) {
            if (!rig->link) continue;
            of_stage.push_back(rig.get());
            all.push_back({rig->status.connected, rig->status.sync});
        }
        const auto first = starter.update(all, TaiClock::now(), now);
        for (const std::size_t late : starter.laggards(all, now))
            log_warning("rig {} is not ready; it will join when it is", of_stage[late]->name);
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
        return !rig.status.connected && !rig.status.is_removed && rig.status.refused.empty() &&
               !rig.relay_answers;
    }

    /// Diagnoses why a rig is not connected.
    void probe(Rig& rig) {
        const Endpoint endpoint = [&] {
            const std::lock_guard lock(mutex);
            return rig.endpoint;
        }();
        auto [address, reason] = reach(endpoint, probe_limit);
        if (reason.empty())
            reason = fmt::format(
                "something at {} accepts connections but does not speak Vantage's protocol: the "
                "rig or this host is stopped or busy, or another program has the port",
                endpoint.text());
        const std::lock_guard lock(mutex);
        if (rig.status.is_removed || rig.endpoint.text() != endpoint.text()) return;
        if (!address.empty()) rig.answering_address = std::move(address);
        if (!rig.status.connected && !rig.relay_answers) rig.status.unreachable = std::move(reason);
    }

    void hand_over(Rig& rig, RigLink::Delivery delivery) {
        ++rig.unhandled;
        if (rig.inbox->push(std::move(delivery))) {
            --rig.unhandled;
            const std::lock_guard lock(mutex);
            ++rig.status.queue_dropped;
        }
    }

    void decode_all(std::size_t number, Rig& rig, BoundedQueue<RigLink::Delivery>& inbox) {
        name_this_thread("decode");
        Decoder decoder;
        std::chrono::milliseconds patience = first_probe_after;
        // On another thread, so that a rig that returns meanwhile does not wait for a name lookup.
        std::future<void> probing;
        while (true) {
            const std::optional<RigLink::Delivery> delivery = inbox.pop_for(patience);
            if (!delivery && inbox.closed()) return;
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
                decode(number, rig, decoder, *delivery);
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

    void decode(std::size_t number, Rig& rig, Decoder& decoder, const RigLink::Delivery& delivery) {
        TraceSpan span("decode");
        span.in(TraceId::of_rig_frame(number, delivery.message.counters.sent), TraceFlow::ends);
        const MonotonicTime start = MonotonicClock::now();
        const PackedFrame& packed = *delivery.frame;
        auto frame = std::make_shared<RigFrame>(
            rig.is_decoded ? decoder.frames.decode(packed.header, packed.colour, packed.disparity)
                           : decode_frame_head(packed.header).frame);
        frame->packed = delivery.frame;
        if (frame->rig != delivery.message.rig || frame->session != delivery.message.session)
            fail("a frame of rig {} came over the link of rig {}", frame->rig,
                 delivery.message.rig);
        const MonotonicTime end = MonotonicClock::now();
        const TaiTime decoded = TaiClock::now();

        // The right image comes occasionally; a consumer that takes only some frames needs it, too.
        if (!frame->right_jpeg && frame->session == decoder.session)
            frame->right_jpeg = decoder.right_jpeg;
        decoder.right_jpeg = frame->right_jpeg;
        decoder.session = frame->session;
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
            for (const FrameSet::Slot& slot : set.slots)
                if (slot.frame) ++named(slot.rig).status.in_frame_sets;
            ++sets;
            complete_frame_sets += set.present() == static_cast<int>(set.slots.size());
            newest_frame_set = now;
            if (const std::optional<FrameSet> dropped = closed_frame_sets.push(std::move(set)))
                for (const FrameSet::Slot& slot : dropped->slots)
                    if (slot.frame) ++named(slot.rig).status.in_dropped_frame_sets;
        }
    }

    bool films() const { return purpose == Purpose::film || purpose == Purpose::calibrate; }

    /// Precondition: mutex is held.
    void show(Rig& rig, RigLink::View view, MonotonicTime now) const {
        const bool warns = purpose != Purpose::report;
        RigStatus& status = rig.status;
        const bool goes_on = status.connected && view.restarts == status.restarts;
        if (view.connected != status.connected)
            tell_state(
                rig, false,
                fmt::format("rig {} is {}", rig.name, view.connected ? "connected" : "gone"));
        rig.relay_answers = view.refusal_passes && !view.refused.empty();
        if (view.connected) status.unreachable.clear();
        if (rig.relay_answers) {
            if (warns && view.refused != status.unreachable) tell_state(rig, false, view.refused);
            status.unreachable = std::exchange(view.refused, {});
        }
        if (warns && !view.refused.empty() && view.refused != status.refused)
            tell_state(rig, true, view.refused);
        rig.outages.note(view.connected, view.heard);
        status.outages = rig.outages.outages();
        status.outage_s = std::chrono::duration<double>(rig.outages.length(now)).count();
        status.restarts = view.restarts;
        const std::string rate_before = rate_warning(status);
        const bool had_tai_warning = status.connected && !tai_warning(status).empty();
        if (goes_on && view.sync.clock_steps > status.sync.clock_steps)
            tell_state(
                rig, true,
                fmt::format("rig {}: {}; its frames are, or were, off the other rigs' by as much: "
                            "check that its clock follows the stage's, and verify the timing by "
                            "light (vantage-calib sync)",
                            rig.name, clock_step_text(view.sync)));
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
            tell_state(rig, true,
                       fmt::format("rig {}: {}; until then latencies are unknown and its frames "
                                   "may miss their frame sets",
                                   rig.name, tai));
        if (warns && view.connected && view.by_datagrams && !status.by_datagrams)
            tell_state(rig, false, fmt::format("rig {}: its frames come over SRT", rig.name));
        if (view.datagram_trouble.empty() || !view.connected)
            rig.datagram_trouble_since.reset();
        else if (status.datagram_trouble.empty())
            rig.datagram_trouble_since = now;
        // The road of a rig that ends does so just before the rig is gone.
        if (warns && rig.datagram_trouble_since &&
            now - *rig.datagram_trouble_since > liveness_limit) {
            rig.datagram_trouble_since.reset();
            tell_state(rig, true,
                       fmt::format("rig {}: its frames come over TCP because {}; the rig offers "
                                   "SRT again",
                                   rig.name, view.datagram_trouble));
        }
        status.by_datagrams = view.by_datagrams;
        status.datagram_trouble = std::move(view.datagram_trouble);
        if (!view.last_error.empty()) status.last_error = std::move(view.last_error);
        if (const std::string rate = rate_warning(status);
            warns && rate != rate_before && !rate.empty())
            tell_state(rig, true, fmt::format("rig {}: {}", rig.name, rate));
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
    /// By number; rigs are added and none is taken away. Only the I/O thread adds, while it holds
    /// the mutex.
    std::vector<std::unique_ptr<Rig>> rigs;
    /// Of rigs that were removed and added again; used by the I/O thread only.
    std::vector<std::future<void>> ended_decoders;

    mutable std::mutex mutex;  ///< guards the members below and the rigs' status; never held
                               ///< during a socket call or a decode
    FrameSetAssembler assembler;
    TakeStarter starter;
    ClockStepWatch own_clock;  ///< used by the I/O thread only
    const double stage_rate_hz;
    std::vector<std::string> numbered_names;  ///< of all rigs, by number
    std::vector<StageConfig::Rig> connected;  ///< the rigs of the newest update
    std::optional<CurveKeys> host_keys;       ///< of the newest update
    std::vector<StageUpdate> updates;         ///< not applied yet
    std::uint64_t first_pulse = 0;            ///< 0: not announced yet; used by the I/O thread only
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
    const auto add = [&](const Impl::Rig& rig) {
        RigStatus& shown = status.rigs.emplace_back(rig.status);
        shown.latency_ms = rig.latency_ms.summary();
        shown.network_ms = rig.network_ms.summary();
        shown.decode_ms = rig.decode_ms.summary();
    };
    for (const std::size_t number : impl_->assembler.order()) add(*impl_->rigs[number]);
    for (const auto& rig : impl_->rigs)
        if (rig->status.is_removed) add(*rig);
    status.sets = impl_->sets;
    status.complete_frame_sets = impl_->complete_frame_sets;
    status.newest_frame_set = impl_->newest_frame_set;
    status.frame_sets_dropped = impl_->closed_frame_sets.dropped_count();
    return status;
}

StageReceiver::Update::Update(std::unique_ptr<Content> content) : content_(std::move(content)) {}
StageReceiver::Update::Update(Update&&) noexcept = default;
StageReceiver::Update::~Update() = default;

const std::vector<std::string>& StageReceiver::Update::names() const { return content_->names; }

StageReceiver::Update StageReceiver::prepare(const StageConfig& stage) const {
    const std::lock_guard lock(impl_->mutex);
    return Update(std::make_unique<Update::Content>(impl_->update_to(stage)));
}

void StageReceiver::follow(Update update) {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->note_newest(*update.content_);
        impl_->updates.push_back(std::move(*update.content_));
    }
    impl_->wake.notify();
}

void StageReceiver::ask(std::string_view rig_name, bool streaming, std::uint32_t rate_divisor) {
    if (rate_divisor < 1 || rate_divisor > max_rate_divisor)
        fail("a rate divisor of {} is outside 1..{}", rate_divisor, max_rate_divisor);
    {
        const std::lock_guard lock(impl_->mutex);
        Impl::Rig& rig = impl_->named(rig_name);
        if (rig.status.is_removed) return;
        rig.request.streaming = streaming;
        rig.request.rate_divisor = rate_divisor;
    }
    impl_->wake.notify();
}

void StageReceiver::set_decoded(std::string_view rig_name, bool is_decoded) {
    const std::lock_guard lock(impl_->mutex);
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
