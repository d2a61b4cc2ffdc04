#include "rig_firmware/daemon/rig_daemon.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "common/base/bounded_queue.h"
#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/log_limiter.h"
#include "common/base/this_thread.h"
#include "common/base/time/clock_step_watch.h"
#include "common/base/time/time.h"
#include "common/config/calibration_file.h"
#include "common/gl/context/context_loss.h"
#include "rig_firmware/capture/rig_calibration.h"
#include "rig_firmware/clock/clock_model.h"
#include "rig_firmware/clock/clock_pair.h"
#include "rig_firmware/clock/ptp_state_file.h"
#include "rig_firmware/daemon/gpu_stage.h"
#include "rig_firmware/daemon/health_monitor.h"
#include "rig_firmware/daemon/heartbeat.h"
#include "rig_firmware/daemon/rig_report.h"
#include "rig_firmware/keep/kept_reader.h"
#include "rig_firmware/keep/take_keeper.h"
#include "rig_firmware/trigger/rig_trigger.h"

namespace vantage {
namespace {

// Period at which a waiting thread checks whether it has to stop.
constexpr std::chrono::milliseconds wait_slice(100);

/// Properties of the source that the later stages need.
struct SourceFacts {
    cv::Size size;
    std::vector<LentPicture> specimens;
};

struct CapturedFrame {
    StereoFrame frame;
    float capture_ms = 0;
    MonotonicTime exposed{};
};

/// The part of a rig's health report that never changes.
RigHealth facts_of(const RigConfig& config, const std::optional<StereoCalibration>& calibration) {
    RigHealth facts;
    facts.program_version = version();
    if (calibration) facts.calibration_id = calibration->id;
    if (config.calibration.empty()) return facts;
    const CalibrationRecord record = load_calibration_record(config.calibration);
    facts.calibration_date = record.date;
    facts.calibration_row_rms_px = static_cast<float>(record.row_rms_px);
    return facts;
}

/// Reason for a rig without calibration: takes hold frames with geometry, which needs one.
constexpr const char* keeps_nothing =
    "keeps nothing: [keep] needs a calibration, and this rig has calibration = \"none\"";

/// Packets of one stereo frame that leave the rig.
struct Instant {
    std::optional<RigFrame> view;  ///< empty on a rig without calibration
    std::optional<RigFrame>
        raw_pair;  ///< present if a host asks for it, and always on a rig without views
    MonotonicTime exposed{};
    const RigFrame& either() const { return view ? *view : *raw_pair; }
};

RigFrame raw_pair_of(const StereoFrame& frame, const std::string& calibration_id) {
    RigFrame pair;
    pair.content = RigFrame::Content::raw_pair;
    pair.synchronized = frame.synchronized;
    pair.trigger_index = frame.trigger_index;
    pair.exposure = frame.exposure;
    pair.calibration_id = calibration_id;
    pair.colour = frame.lent_left ? to_colour(*frame.lent_left) : frame.left;
    pair.right = frame.lent_right ? to_colour(*frame.lent_right) : frame.right;
    pair.geometry.width_px = pair.colour.cols;
    pair.geometry.height_px = pair.colour.rows;
    return pair;
}

/// Notes for the support report, shared between threads. The publisher's thread reads them and
/// outlives the rest of the daemon. Thread-safe.
class SharedNotes {
  public:
    void set_at_start(std::vector<std::string> lines) {
        const std::lock_guard lock(mutex_);
        notes_.at_start = std::move(lines);
    }
    /// Keeps the last steps only.
    void add_clock_step(std::string line) {
        constexpr std::size_t most_steps = 20;
        const std::lock_guard lock(mutex_);
        if (notes_.clock_steps.size() == most_steps)
            notes_.clock_steps.erase(notes_.clock_steps.begin());
        notes_.clock_steps.push_back(std::move(line));
    }
    RigNotes notes() const {
        const std::lock_guard lock(mutex_);
        return notes_;
    }

  private:
    mutable std::mutex mutex_;
    RigNotes notes_;
};

}  // namespace

struct RigDaemon::Impl {
    Impl(const RigConfig& rig_config, std::uint64_t most_frames)
        : config(rig_config),
          frame_limit(most_frames),
          publisher(rig_config.stream, rig_config.name),
          trigger(RigTrigger::make(rig_config)),
          keeper(rig_config.keep.folder.empty() || rig_config.uncalibrated
                     ? nullptr
                     : std::make_unique<TakeKeeper>(rig_config.keep, rig_config.name,
                                                    rig_config.source.rate_hz)) {
        if (keeper)
            publisher.serve_kept(
                [reader = std::make_shared<KeptReader>(config.keep.folder, config.name,
                                                       config.source.rate_hz)](
                    std::uint64_t from, std::uint64_t to) { return reader->first_of(from, to); });
        // Hosts may be connected already; they learn the role of this rig before its state.
        RigSync first;
        first.rate_hz = config.source.rate_hz;
        first.tai_offset_s = read_kernel_clock().tai_offset_s;
        publisher.report(first);
    }

    void start();
    void capture(std::promise<SourceFacts> ready, const std::future<void>& go);
    void capture_one(StereoSource& source);
    void run_gpu(const std::optional<StereoCalibration>& calibration,
                 const std::vector<LentPicture>& specimens, std::promise<void> ready);
    void set_up_gpu(std::optional<GpuStage>& gpu, const StereoCalibration& calibration,
                    const std::vector<LentPicture>& specimens);
    void note_compiling(const ProgramProgress& progress);
    std::vector<std::string> report() const;

    /// One line about this rig's own recording; empty if none is configured.
    std::string keeps_line() const {
        if (keeper) return keeper->line();
        return config.keep.folder.empty() ? "" : keeps_nothing;
    }
    void publish();
    void keep_in_step(const RigHealth& facts);
    void announce(std::uint64_t first_pulse);
    RigSync sync_now(const std::optional<PtpReading>& clock, int tai_offset_s,
                     const ClockModel::State& time_of_day) const;
    void stop();

    /// Runs a thread's work under a name that debuggers and `top -H` show. An exception stops the
    /// pipeline and is kept for rethrow_failure().
    template <class Work>
    void guarded(Heartbeat& heart, Work work) {
        name_this_thread(heart.worker().c_str());
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
            stopping = true;
        }
        heart.rest();
    }

    template <class Change>
    void count(Change change) {
        const std::lock_guard lock(mutex);
        change(counters);
        // Reported under the lock, so that no older count follows a newer one.
        publisher.report(counters);
    }

    const RigConfig config;
    const std::uint64_t frame_limit;
    Publisher publisher;
    const std::unique_ptr<RigTrigger> trigger;  ///< null for the role free
    const std::unique_ptr<TakeKeeper> keeper;   ///< null if this rig records nothing

    BoundedQueue<CapturedFrame> captured{1};
    BoundedQueue<Instant> matched{1};

    mutable std::mutex mutex;
    RigCounters counters;
    std::vector<SourceCounter> source_counters;
    CameraIntake::Counts lent_pictures;
    std::optional<ClockModel::State> sensor_clock;
    RigSync sync;
    PercentileRecorder capture_ms, rectify_ms, match_ms, pack_ms, latency_ms;
    std::vector<std::string> source_report, gpu_report;
    const std::shared_ptr<SharedNotes> notes = std::make_shared<SharedNotes>();
    std::string starting;  ///< see DaemonStatus
    std::uint64_t gpu_restarts = 0;
    std::exception_ptr failure;

    MonotonicTime compiling_logged{};                     ///< used by the GPU's thread only
    std::uint64_t refused_pulse = 0;                      ///< used by the sync thread only
    ClockStepWatch capture_steps;                         ///< used by the capture thread only
    LogLimiter refused_frames{std::chrono::seconds(10)};  ///< used by the publishing thread only

    Heartbeat capture_heart{"capture"}, gpu_heart{"gpu"}, publish_heart{"publish"},
        sync_heart{"sync"};

    std::atomic<bool> stopping = false;
    std::atomic<bool> finished = false;
    std::thread capture_thread, gpu_thread, publish_thread, sync_thread;
};

void RigDaemon::Impl::start() {
    std::promise<SourceFacts> source_ready;
    std::future<SourceFacts> source = source_ready.get_future();
    std::promise<void> gpu_ready;
    capture_thread =
        std::thread([this, p = std::move(source_ready), go = gpu_ready.get_future()]() mutable {
            guarded(capture_heart, [&] { capture(std::move(p), go); });
            captured.close();
        });
    SourceFacts source_facts = source.get();
    std::optional<StereoCalibration> calibration;
    if (config.uncalibrated) {
        publisher.serve_raw_pairs_only(fmt::format(
            "rig {} has no calibration yet (calibration = \"none\") and sends no views; "
            "make one with: vantage-calib stereo --live",
            config.name));
        if (!config.keep.folder.empty()) log_warning("rig {} {}", config.name, keeps_nothing);
    } else {
        calibration = rig_calibration(config, source_facts.size);
    }
    if (calibration) {
        require_matching(config, *calibration);
        starting = "setting up the GPU";
    }
    gpu_thread = std::thread([this, calibration, specimens = std::move(source_facts.specimens),
                              p = std::move(gpu_ready)]() mutable {
        guarded(gpu_heart, [&] { run_gpu(calibration, specimens, std::move(p)); });
        matched.close();
    });
    publish_heart.beat();
    sync_heart.beat();
    publish_thread = std::thread([this] {
        guarded(publish_heart, [&] { publish(); });
        finished = true;
    });
    sync_thread = std::thread([this, facts = facts_of(config, calibration)] {
        guarded(sync_heart, [&] { keep_in_step(facts); });
    });
}

void RigDaemon::Impl::capture(std::promise<SourceFacts> ready, const std::future<void>& go) {
    std::unique_ptr<StereoSource> source;
    try {
        source = make_source(config);
        source->use(trigger.get());
        // Raw pairs need images in memory, so an uncalibrated rig borrows no buffers.
        if (!config.uncalibrated) source->lend();
        const std::lock_guard lock(mutex);
        source_report = source->report();
    } catch (...) {
        ready.set_exception(std::current_exception());
        return;
    }
    capture_heart.beat();
    ready.set_value({source->size(), source->specimens()});
    // Frames that arrive before the GPU's programs are compiled are discarded.
    while (!stopping && go.wait_for(wait_slice) != std::future_status::ready) capture_heart.beat();
    while (!stopping && !source->ended()) {
        capture_heart.beat();
        capture_one(*source);
    }
}

void RigDaemon::Impl::capture_one(StereoSource& source) {
    if (source.works_on_demand()) {
        // Like a triggered sensor, the virtual source exposes on pulses only.
        if (trigger && trigger->pulses() == 0) {
            std::this_thread::sleep_for(wait_slice);
            return;
        }
        if (!captured.wait_for_room(wait_slice)) return;
    }
    (void)capture_steps.look();
    std::optional<StereoFrame> frame = source.next(wait_slice);
    const bool clock_was_set = capture_steps.look().has_value();
    // Counted before the frame is handed on, so that `captured` is never below `published`.
    count([&](RigCounters& c) {
        c.missed = source.missed();
        c.captured += frame.has_value();
        source_counters = source.counters();
        sensor_clock = source.clock();
    });
    if (!frame) return;
    // The clock was set since the index of this frame's pulse was computed.
    if (clock_was_set) return count([](RigCounters& c) { ++c.late; });
    const MonotonicTime exposed = frame->exposed;
    // Some drivers stamp a frame with the end of its period, which is still in the future.
    const auto age_ms = static_cast<float>(std::max(0.0, ms_since(exposed)));
    if (captured.push({std::move(*frame), age_ms, exposed}))
        count([](RigCounters& c) { ++c.late; });
}

/// Passes the host's first pulse to the trigger, and the state of pulses, clocks and computer to
/// the host.
void RigDaemon::Impl::keep_in_step(const RigHealth& facts) {
    constexpr std::chrono::milliseconds look_every(50);
    constexpr int looks_per_second = 20;
    std::optional<PtpReading> clock;
    int tai_offset_s = 0;
    HealthMonitor monitor(facts);
    ClockModel time_of_day;  // CLOCK_MONOTONIC is never set.
    for (int look = 0; !stopping && !finished; ++look) {
        sync_heart.beat();
        if (look % looks_per_second == 0) {
            clock = read_ptp();
            tai_offset_s = read_kernel_clock().tai_offset_s;
            RigHealth health = monitor.look(publisher.status().counters, MonotonicClock::now());
            health.keeps = keeps_line();
            {
                const std::lock_guard lock(mutex);
                health.starting = starting;
            }
            publisher.report(health);
        }
        if (trigger) {
            trigger->rethrow_failure();
            announce(publisher.announced_pulse());
        }
        const ClockPair pair = ClockPair::now();
        const std::uint64_t steps = time_of_day.state().steps;
        time_of_day.observe(pair.monotonic, pair.tai);
        if (time_of_day.state().steps != steps) {
            const double step_ms = time_of_day.state().last_step_ns / 1e6;
            log_warning(
                "{}: this computer's clock was set by {:+.1f} ms; frames before and after it are "
                "counted by different clocks",
                config.name, step_ms);
            notes->add_clock_step(fmt::format(
                "by {:+.1f} ms, {:.0f} s after this computer started", step_ms,
                std::chrono::duration<double>(MonotonicClock::now().time_since_epoch()).count()));
            // A first pulse that was refused with the old clock may be possible with the new one.
            refused_pulse = 0;
        }
        const RigSync now = sync_now(clock, tai_offset_s, time_of_day.state());
        publisher.report(now);
        {
            const std::lock_guard lock(mutex);
            sync = now;
        }
        std::this_thread::sleep_for(look_every);
    }
}

/// `first_pulse` is 0 if no host announced one. A wrong announcement is the host's error and does
/// not end the daemon.
void RigDaemon::Impl::announce(std::uint64_t first_pulse) {
    if (first_pulse == 0 || first_pulse == refused_pulse) return;
    try {
        trigger->announce(first_pulse);
    } catch (const Error& error) {
        log_error("{}: {}", config.name, error.what());
        refused_pulse = first_pulse;
    }
}

RigSync RigDaemon::Impl::sync_now(const std::optional<PtpReading>& clock, int tai_offset_s,
                                  const ClockModel::State& time_of_day) const {
    constexpr double ns_per_ms = 1e6;
    RigSync now;
    now.ready = true;
    now.tai_offset_s = tai_offset_s;
    now.rate_hz = config.source.rate_hz;
    if (trigger) {
        const TriggerStatus status = trigger->status();
        now.role = config.trigger.role == "lead" ? RigSync::Role::lead : RigSync::Role::follow;
        now.ready = status.is_armed;
        now.first_pulse = status.first_pulse;
        now.pulses = status.pulses;
        now.skipped = status.skipped;
        now.unsynchronized = status.unsynchronized;
        now.lateness_p50_us = static_cast<float>(status.lateness_us.p50);
        now.lateness_p99_us = static_cast<float>(status.lateness_us.p99);
        now.lateness_max_us = static_cast<float>(status.lateness_us.max);
    } else {
        now.first_pulse = publisher.announced_pulse();
    }
    if (clock) {
        now.disciplined = clock->is_disciplined();
        now.ptp_offset_ns = clock->ptp.offset_ns;
        now.ptp_path_delay_ns = clock->ptp.path_delay_ns;
        now.ptp_state = clock->ptp.port_state;
    }
    now.clock_steps = time_of_day.steps;
    now.clock_step_ms = time_of_day.last_step_ns / ns_per_ms;
    const std::lock_guard lock(mutex);
    now.ready = now.ready && starting.empty();
    if (sensor_clock) now.clock_ppm = sensor_clock->ppm;
    return now;
}

void RigDaemon::Impl::run_gpu(const std::optional<StereoCalibration>& calibration,
                              const std::vector<LentPicture>& specimens, std::promise<void> ready) {
    std::optional<GpuStage> gpu;
    if (calibration) {
        set_up_gpu(gpu, *calibration, specimens);
    } else {
        const std::lock_guard lock(mutex);
        gpu_report = {"not calibrated: raw pairs for vantage-calib, no views"};
    }
    gpu_heart.beat();
    ready.set_value();
    // After this many resets without a frame between them, a new context does not help.
    constexpr int most_resets_in_a_row = 3;
    int resets_in_a_row = 0;
    while (!(captured.closed() && captured.size() == 0)) {
        gpu_heart.beat();
        std::optional<CapturedFrame> next = captured.pop_for(wait_slice);
        if (!next) continue;
        Instant instant;
        instant.exposed = next->exposed;
        if (!gpu || publisher.wants_raw_pair(next->frame.trigger_index))
            instant.raw_pair = raw_pair_of(next->frame, calibration ? calibration->id : "");
        if (gpu) {
            try {
                instant.view = gpu->process(std::move(next->frame));
                resets_in_a_row = 0;
            } catch (const ContextLost& lost) {
                count([](RigCounters& c) { ++c.late; });
                if (++resets_in_a_row == most_resets_in_a_row) throw;
                log_error("{}: {}; the GPU is set up anew", config.name, lost.what());
                {
                    const std::lock_guard lock(mutex);
                    ++gpu_restarts;
                }
                next.reset();
                set_up_gpu(gpu, *calibration, specimens);
                continue;
            }
            const std::lock_guard lock(mutex);
            lent_pictures = gpu->lent_pictures();
        }
        for (std::optional<RigFrame>* frame : {&instant.view, &instant.raw_pair})
            if (*frame) (*frame)->times.capture_ms = next->capture_ms;
        if (matched.push(std::move(instant))) count([](RigCounters& c) { ++c.late; });
    }
}

/// Compiles the shaders; creates a new GL context first if there was one before.
void RigDaemon::Impl::set_up_gpu(std::optional<GpuStage>& gpu, const StereoCalibration& calibration,
                                 const std::vector<LentPicture>& specimens) {
    gpu.reset();
    const MonotonicTime begin = MonotonicClock::now();
    note_compiling({});
    gpu.emplace(config, calibration, specimens,
                [this](const ProgramProgress& progress) { note_compiling(progress); });
    gpu_heart.beat();
    const std::vector<std::string> lines = gpu->report();
    log_info("{}: the shaders were compiled in {:.1f} s", config.name,
             to_ms(MonotonicClock::now() - begin) * 1e-3);
    {
        const std::lock_guard lock(mutex);
        gpu_report = lines;
        starting.clear();
    }
    notes->set_at_start(report());
}

void RigDaemon::Impl::note_compiling(const ProgramProgress& progress) {
    // A shader that compiles for longer than this counts as stuck.
    constexpr std::chrono::minutes longest_compiling(5);
    constexpr std::chrono::seconds log_every(1);
    const MonotonicTime now = MonotonicClock::now();
    gpu_heart.beat(now + longest_compiling);
    std::string text = "setting up the GPU";
    if (progress.used > 0)
        text = fmt::format("compiling shaders, {} of {}", progress.used, progress.made);
    else if (progress.made > 0)
        text = fmt::format("reading shaders, {} so far", progress.made);
    if (now - compiling_logged >= log_every) {
        compiling_logged = now;
        log_info("{}: {} {}", config.name, text, progress.file);
    }
    const std::lock_guard lock(mutex);
    starting = std::move(text);
}

void RigDaemon::Impl::publish() {
    std::uint64_t published = 0;
    std::string refusal;
    while (!(matched.closed() && matched.size() == 0)) {
        publish_heart.beat();
        std::optional<Instant> instant = matched.pop_for(wait_slice);
        if (!instant) continue;
        if (frame_limit > 0 && published == frame_limit) {
            count([](RigCounters& c) { ++c.late; });
            continue;
        }
        const RigStageTimes times = instant->either().times;
        const MonotonicTime start = MonotonicClock::now();
        bool is_refused = false;
        for (std::optional<RigFrame>* frame : {&instant->view, &instant->raw_pair}) {
            if (!*frame) continue;
            {
                const std::lock_guard lock(mutex);
                (*frame)->counters = counters;
            }
            try {
                const auto packed = publisher.publish(std::move(**frame));
                if (keeper && packed) keeper->offer(packed);
            } catch (const FrameRefused& error) {
                is_refused = true;
                refusal = error.what();
            }
        }
        if (is_refused) count([](RigCounters& c) { ++c.late; });
        if (const auto lost = refused_frames.count(is_refused, MonotonicClock::now()))
            log_error("{}: {} frames could not be sent and are lost; the last: {}", config.name,
                      *lost, refusal);
        if (is_refused) continue;
        const auto packing = MonotonicClock::now() - start;
        const double exposure_to_published_ms = ms_since(instant->exposed);
        if (++published == frame_limit) stopping = true;
        const std::lock_guard lock(mutex);
        capture_ms.add(times.capture_ms);
        rectify_ms.add(times.rectify_ms);
        match_ms.add(times.match_ms);
        // The second summand is the packing that was done while the GPU matched.
        pack_ms.add(to_ms(packing) + times.pack_ms);
        latency_ms.add(exposure_to_published_ms);
    }
}

void RigDaemon::Impl::stop() {
    stopping = true;
    // Threads end in the order of the pipeline: the source's thread closes its queue, and each
    // stage drains the queue before it.
    if (capture_thread.joinable()) capture_thread.join();
    captured.close();
    if (gpu_thread.joinable()) gpu_thread.join();
    matched.close();
    if (publish_thread.joinable()) publish_thread.join();
    if (sync_thread.joinable()) sync_thread.join();
}

RigDaemon::RigDaemon(const RigConfig& config, std::uint64_t frame_limit)
    : impl_(std::make_unique<Impl>(config, frame_limit)) {
    try {
        impl_->start();
        impl_->notes->set_at_start(report());
        impl_->publisher.serve_reports(
            [config, notes = impl_->notes](const std::atomic<bool>& stopping) {
                return rig_report(config, notes->notes(), stopping);
            });
    } catch (...) {
        impl_->stop();
        throw;
    }
}

RigDaemon::~RigDaemon() { impl_->stop(); }

bool RigDaemon::running() const { return !impl_->finished && !impl_->stopping; }

void RigDaemon::rethrow_failure() const {
    std::exception_ptr failure;
    {
        const std::lock_guard lock(impl_->mutex);
        failure = impl_->failure;
    }
    if (failure) std::rethrow_exception(failure);
}

std::string RigDaemon::stuck_worker(std::chrono::nanoseconds limit) const {
    const MonotonicTime now = MonotonicClock::now();
    std::string longest_silent;
    for (const Heartbeat* heart :
         {&impl_->capture_heart, &impl_->gpu_heart, &impl_->publish_heart, &impl_->sync_heart}) {
        const std::chrono::nanoseconds silence = heart->silence(now);
        if (silence <= limit) continue;
        limit = silence;
        longest_silent = heart->worker();
    }
    return longest_silent;
}

void RigDaemon::stop() { impl_->stop(); }

DaemonStatus RigDaemon::status() const {
    DaemonStatus status;
    status.publisher = impl_->publisher.status();
    const std::lock_guard lock(impl_->mutex);
    const RigCounters& own = impl_->counters;
    RigCounters& shown = status.publisher.counters;
    shown.captured = own.captured;
    shown.missed = own.missed;
    shown.late = own.late;
    status.source_counters = impl_->source_counters;
    for (SourceCounter& counter : status.source_counters)
        if (counter.name == copied_pictures) counter.count += impl_->lent_pictures.copied;
    status.source_counters.push_back({"imported_pictures", impl_->lent_pictures.imported});
    status.source_counters.push_back({"gpu_restarts", impl_->gpu_restarts});
    status.starting = impl_->starting;
    status.sync = impl_->sync;
    status.keeps = impl_->keeps_line();
    if (impl_->keeper) status.kept_files_erased = impl_->keeper->erased();
    status.capture_ms = impl_->capture_ms.summary();
    status.rectify_ms = impl_->rectify_ms.summary();
    status.match_ms = impl_->match_ms.summary();
    status.pack_ms = impl_->pack_ms.summary();
    status.latency_ms = impl_->latency_ms.summary();
    return status;
}

std::string RigDaemon::endpoint() const { return impl_->publisher.endpoint(); }

std::vector<std::string> RigDaemon::report() const { return impl_->report(); }

std::vector<std::string> RigDaemon::Impl::report() const {
    const std::lock_guard lock(mutex);
    std::vector<std::string> lines = source_report;
    lines.insert(lines.end(), gpu_report.begin(), gpu_report.end());
    if (trigger)
        for (std::string& line : trigger->report()) lines.push_back(std::move(line));
    const std::string key = publisher.public_key();
    lines.push_back(
        fmt::format("publishing on {}, {}", publisher.endpoint(),
                    key.empty() ? "without keys (this computer only)" : "public key " + key));
    return lines;
}

}  // namespace vantage
