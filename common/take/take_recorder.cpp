#include "common/take/take_recorder.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "common/base/time/timecode.h"

namespace vantage {
namespace {

constexpr std::size_t piece_bytes = 4 << 20;
constexpr std::size_t most_bytes = 64 << 20;
constexpr std::chrono::milliseconds longest{300};

/// The disk has to be faster than the data rate by this factor, as it has other work, too.
constexpr double disk_margin = 1.5;
/// Free space that a take needs at its start, in seconds of data.
constexpr double least_room_s = 10;
/// How long the thread waits for work before it checks whether data is due on disk.
constexpr std::chrono::milliseconds patience{100};
/// Frames per rig that are encoded in one go. On a busy computer the thread runs rarely and has to
/// do much at a time, or its queue would grow without bound.
constexpr std::size_t most_frames_a_rig = 16;
/// Data that is in memory only for longer than this is a trouble, and a sync that takes longer.
constexpr std::chrono::seconds long_unwritten{1}, long_sync{3};
/// Samples per block of sound in the file.
constexpr std::int64_t sound_block = sound_rate_hz / 10;
/// Sound kept until the first frame comes: it may have been heard since that frame's exposure.
constexpr std::int64_t sound_before = 3 * sound_rate_hz;
constexpr double sound_mb_s = 1e-6 * sound_rate_hz * stored_sound_bytes;

nlohmann::ordered_json calibration_json(const RigFrame& frame) {
    const RectifiedStereo& geometry = frame.geometry;
    return {{"id", frame.calibration_id},
            {"width_px", geometry.width_px},
            {"height_px", geometry.height_px},
            {"f_px", geometry.f_px},
            {"cx_left_px", geometry.cx_left_px},
            {"cx_right_px", geometry.cx_right_px},
            {"cy_px", geometry.cy_px},
            {"baseline_m", geometry.baseline_m},
            {"place_is_assumed", frame.place_is_assumed},
            {"world_from_camera", pose_json(frame.world_from_camera)}};
}

}  // namespace

double measure_disk_mb_s(const std::filesystem::path& folder) {
    std::string name = (folder / ".vantage-disk-XXXXXX").string();
    const UniqueFd file(mkstemp(name.data()));
    if (!file) fail("cannot write to {}: {}", folder.string(), std::strerror(errno));
    ::unlink(name.c_str());
    // Random data, since disks that compress would be fast with zeros.
    std::vector<std::uint32_t> piece(piece_bytes / sizeof(std::uint32_t));
    std::uint32_t noise = 1;
    for (std::uint32_t& word : piece) word = noise = noise * 1664525u + 1013904223u;
    const MonotonicTime start = MonotonicClock::now();
    std::size_t written = 0;
    while (written < most_bytes && MonotonicClock::now() - start < longest) {
        const ssize_t n = ::write(file.get(), piece.data(), piece_bytes);
        if (n < 0) fail("cannot write to {}: {}", folder.string(), std::strerror(errno));
        written += static_cast<std::size_t>(n);
        ::fdatasync(file.get());
    }
    const double seconds = std::chrono::duration<double>(MonotonicClock::now() - start).count();
    return static_cast<double>(written) / 1e6 / seconds;
}

double free_disk_mb(const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(folder, error);
    if (error) fail("cannot write to {}: {}", folder.string(), error.message());
    return static_cast<double>(space.available) / 1e6;
}

struct TakeRecorder::Take {
    std::filesystem::path path;
    Stage stage;
    std::vector<std::string> names;  ///< of the tracks
    std::optional<TakeWriter> writer;
    nlohmann::ordered_json calibrations;       ///< from the rigs' first frames, for people
    std::vector<std::optional<TakeRig>> rigs;  ///< from the first frame of each
    std::vector<std::unique_ptr<FrameStorer>> storers;
    std::vector<Item> held;  ///< until there is a writer
    std::deque<SoundBlock> held_sound;
    SoundBlock sound;  ///< incomplete block
    std::optional<MonotonicTime> first_arrival;
    std::optional<TaiTime> origin;
    int tai_offset_s = 0;
    double bytes_a_pulse = 0;  ///< from the rigs' first frames
    std::chrono::nanoseconds longest_unwritten{0};
    bool is_lateness_told = false, is_sync_told = false;
    double disk_mb_s = 0;
    std::vector<std::string> told;  ///< per rig: the reason of the last refusal
    std::string failure;            ///< empty: none
};

/// Notes that the thread is in a call of the writer, which a slow disk blocks.
class TakeRecorder::Writing {
  public:
    explicit Writing(TakeRecorder& recorder) : recorder_(recorder) {
        const std::lock_guard lock(recorder_.mutex_);
        recorder_.writing_since_ = MonotonicClock::now();
    }
    ~Writing() {
        const std::lock_guard lock(recorder_.mutex_);
        recorder_.round_writing_ += MonotonicClock::now() - *recorder_.writing_since_;
        recorder_.writing_since_.reset();
    }
    Writing(const Writing&) = delete;
    Writing& operator=(const Writing&) = delete;

  private:
    TakeRecorder& recorder_;
};

std::size_t TakeRecorder::Item::bytes() const {
    return frame   ? frame->packed->bytes()
           : sound ? sizeof(float) * sound->samples.size()
                   : sizeof(Item);
}

TakeRecorder::TakeRecorder(Settings settings) : settings_(std::move(settings)) {
    stage_ = {settings_.rigs, {}, settings_.show, settings_.attachments};
    for (std::size_t number = 0; number < stage_.rigs.size(); ++number)
        stage_.recorded.push_back(number);
    for (const std::string& rig : settings_.rigs) state_.rigs.push_back({rig, 0, 0, 0});
    thread_ = std::thread([this] { run(); });
}

TakeRecorder::~TakeRecorder() {
    end();
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = true;
    }
    woken_.notify_all();
    thread_.join();
}

void TakeRecorder::change_stage(Stage stage) {
    const std::lock_guard lock(mutex_);
    stage_ = std::move(stage);
}

void TakeRecorder::offer(const ArrivedFrame& frame) {
    offer_with_pre_roll({frame, {}, nullptr, frame.arrival});
}

void TakeRecorder::offer(const CameraRecord& camera, MonotonicTime now) {
    offer_with_pre_roll({std::nullopt, camera, nullptr, now});
}

void TakeRecorder::offer(const SoundBlock& sound) {
    offer_with_pre_roll(
        {std::nullopt, {}, std::make_shared<const SoundBlock>(sound), MonotonicClock::now()});
}

void TakeRecorder::offer_with_pre_roll(Item item) {
    {
        const std::lock_guard lock(mutex_);
        const MonotonicTime arrival = item.arrival;
        const std::size_t bytes = item.bytes();
        // What comes after the end of a take belongs to the next.
        if (!is_taking_ || is_ending_) {
            if (settings_.pre_roll.count() == 0) return;
            pre_roll_.push_back(std::move(item));
            pre_roll_bytes_ += bytes;
            while (arrival - pre_roll_.front().arrival > settings_.pre_roll) {
                pre_roll_bytes_ -= pre_roll_.front().bytes();
                pre_roll_.pop_front();
            }
            return;
        }
        push(std::move(item));
    }
    woken_.notify_all();
}

/// Precondition: mutex_ is held.
void TakeRecorder::push(Item item) {
    queued_bytes_ += item.bytes();
    queue_.push_back(std::move(item));
    while (queued_bytes_ > most_queued_bytes_ && queue_.size() > 1) {
        const Item& oldest = queue_.front();
        if (oldest.frame) ++state_.rigs[row_of(oldest.frame->rig)].dropped;
        if (oldest.sound) state_.sound_dropped += static_cast<std::uint64_t>(oldest.sound->count());
        queued_bytes_ -= oldest.bytes();
        queue_.pop_front();
    }
}

/// The row of a rig in the state, which a rig without a track gets with its first frame.
/// Precondition: mutex_ is held.
std::size_t TakeRecorder::row_of(std::size_t rig) {
    const auto [place, is_new] = rows_.try_emplace(rig, state_.rigs.size());
    if (is_new) {
        const std::string name = rig < stage_.rigs.size() ? stage_.rigs[rig] : "?";
        log_warning(
            "{} does not have the frames of rig {}, which was not in the stage when it began; end "
            "the take and begin another one to record the rig",
            state_.path, name);
        state_.rigs.push_back({name, 0, 0, 0});
    }
    return place->second;
}

/// The oldest items, with at most a bounded number of frames per rig; frames name their track in
/// place of their rig. Precondition: mutex_ is held.
std::vector<TakeRecorder::Item> TakeRecorder::pop_some() {
    std::vector<Item> items;
    std::vector<std::size_t> frames(tracks_);
    while (!queue_.empty()) {
        Item& first = queue_.front();
        const std::size_t row = first.frame ? row_of(first.frame->rig) : 0;
        const bool has_track = !first.frame || row < tracks_;
        if (first.frame && has_track && ++frames[row] > most_frames_a_rig) break;
        queued_bytes_ -= first.bytes();
        if (has_track) {
            if (first.frame) first.frame->rig = row;
            items.push_back(std::move(first));
        } else {
            ++state_.rigs[row].refused;
        }
        queue_.pop_front();
    }
    return items;
}

void TakeRecorder::begin(const std::filesystem::path& path) {
    require_new_take(path, "recorded");
    {
        const std::lock_guard lock(mutex_);
        if (is_ending_)
            fail("cannot begin {} yet: {} is still being written", path.string(), state_.path);
        if (is_taking_) return;
        is_taking_ = true;
        is_ending_ = false;
        begin_ = path;
        asked_ = MonotonicClock::now();
        queue_ = std::exchange(pre_roll_, {});
        queued_bytes_ = std::exchange(pre_roll_bytes_, 0);
        most_queued_bytes_ = queued_bytes_ + settings_.queue_bytes;
        const std::uint64_t takes = state_.takes + 1;
        state_ = TakeState();
        state_.phase = TakePhase::opening;
        state_.path = path.string();
        state_.takes = takes;
        state_.has_sound = settings_.has_sound;
        rows_.clear();
        for (const std::size_t rig : stage_.recorded) {
            rows_.emplace(rig, state_.rigs.size());
            state_.rigs.push_back({stage_.rigs[rig], 0, 0, 0});
        }
        tracks_ = state_.rigs.size();
    }
    woken_.notify_all();
}

void TakeRecorder::end() {
    {
        const std::lock_guard lock(mutex_);
        if (!is_taking_) return;
        is_ending_ = true;
    }
    woken_.notify_all();
}

void TakeRecorder::finish() {
    end();
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [&] { return !is_taking_; });
}

bool TakeRecorder::is_running() const {
    const std::lock_guard lock(mutex_);
    return is_taking_ && !is_ending_;
}

TakeState TakeRecorder::state() const {
    const std::lock_guard lock(mutex_);
    TakeState state = state_;
    state.trouble = trouble(MonotonicClock::now());
    return state;
}

/// Whether the present round, or a call of the writer in it, has mostly waited for the disk.
/// Precondition: mutex_ is held.
bool TakeRecorder::is_disk_slow(MonotonicTime now) const {
    return writing_since_ || 2 * round_writing_ > now - round_began_;
}

/// Precondition: mutex_ is held.
std::string TakeRecorder::trouble(MonotonicTime now) const {
    if (state_.phase != TakePhase::recording) return "";
    std::optional<MonotonicTime> oldest = round_arrival_;
    if (!oldest && !queue_.empty()) oldest = queue_.front().arrival;
    // The pre-roll was in memory on purpose until the take was requested.
    if (oldest) oldest = std::max(*oldest, asked_);
    const auto seconds_since = [&](MonotonicTime time) {
        return std::chrono::duration<double>(now - time).count();
    };
    if (oldest && now - *oldest > long_unwritten)
        return fmt::format("{}: data waits {:.0f} s to be written",
                           is_disk_slow(now) ? "the disk is slow" : "the computer is overloaded",
                           seconds_since(*oldest));
    if (syncing_since_ && now - *syncing_since_ > long_sync)
        return fmt::format("the disk is slow: a power cut would lose the last {:.0f} s",
                           seconds_since(*syncing_since_));
    return "";
}

TakeRecorder::PreRoll TakeRecorder::pre_roll() const {
    const std::lock_guard lock(mutex_);
    if (pre_roll_.empty()) return {};
    return {pre_roll_bytes_,
            std::chrono::duration<double>(pre_roll_.back().arrival - pre_roll_.front().arrival)
                .count()};
}

void TakeRecorder::run() {
    name_this_thread("take");
    std::optional<Take> take;
    for (;;) {
        std::vector<Item> items;
        bool is_over = false;
        {
            std::unique_lock lock(mutex_);
            woken_.wait_for(lock, patience, [&] {
                return is_stopping_ || begin_ || !queue_.empty() || is_ending_;
            });
            if (begin_) {
                take.emplace();
                take->path = *std::exchange(begin_, std::nullopt);
                take->stage = stage_;
                for (std::size_t track = 0; track < tracks_; ++track)
                    take->names.push_back(state_.rigs[track].name);
                take->rigs.resize(tracks_);
                take->storers.resize(tracks_);
                take->told.resize(tracks_);
            }
            if (take) items = pop_some();
            round_began_ = MonotonicClock::now();
            round_writing_ = std::chrono::nanoseconds(0);
            if (!items.empty()) round_arrival_ = items.front().arrival;
            is_over = take && items.empty() && is_ending_;
            if (!take && is_stopping_) return;
        }
        if (!take) continue;
        try {
            work(*take, std::move(items));
            if (!take->writer) open_if_ready(*take);
            if (take->writer) {
                const Writing writing(*this);
                take->writer->hand_over();
            }
            if (is_over) close(*take);
        } catch (const std::exception& error) {
            take->failure = error.what();
            log_error("{}", take->failure);
        }
        note(*take);
        if (!is_over && take->failure.empty()) continue;
        const std::string failure = std::move(take->failure);
        take.reset();
        {
            // In one step, since a caller that sees the phase may begin the next take.
            const std::lock_guard lock(mutex_);
            state_.phase = failure.empty() ? TakePhase::none : TakePhase::failed;
            state_.failure = failure;
            is_taking_ = is_ending_ = false;
            queue_.clear();
            queued_bytes_ = 0;
        }
        idle_.notify_all();
    }
}

void TakeRecorder::work(Take& take, std::vector<Item> items) {
    if (take.writer) {
        store(take, items);
        return;
    }
    for (Item& item : items) {
        if (item.sound) take.held_sound.push_back(*item.sound);
        while (!take.first_arrival && !take.held_sound.empty() &&
               take.held_sound.back().end() - take.held_sound.front().first > sound_before)
            take.held_sound.pop_front();
        if (!item.frame) {
            // Before the first frame the take has no origin.
            if (!item.sound && take.first_arrival) take.held.push_back(std::move(item));
            continue;
        }
        try {
            look_at_first(take, item);
            take.held.push_back(std::move(item));
        } catch (const Error& error) {
            refuse(take, *item.frame, error.what());
        }
    }
}

/// Collects the data that a take needs before its file can be created.
void TakeRecorder::look_at_first(Take& take, const Item& item) {
    const ArrivedFrame& frame = *item.frame;
    const FrameHead head = decode_frame_head(frame.packed->header);
    if (!take.rigs[frame.rig]) {
        take.rigs[frame.rig] = take_rig_of(head);
        take.calibrations[take.names[frame.rig]] = calibration_json(head.frame);
        // Disparity takes about as much space here as on the wire.
        take.bytes_a_pulse += static_cast<double>(item.bytes());
    }
    const TaiTime time = head.frame.synchronized
                             ? PulseGrid(settings_.pulse_rate_hz).time_of(head.frame.trigger_index)
                             : head.frame.exposure;
    if (!take.origin || time < *take.origin) {
        take.origin = time;
        take.tai_offset_s = head.frame.sync.tai_offset_s;
    }
    if (!take.first_arrival) take.first_arrival = MonotonicClock::now();
}

void TakeRecorder::open_if_ready(Take& take) {
    if (!take.first_arrival) return;
    const bool are_all_there = std::all_of(take.rigs.begin(), take.rigs.end(),
                                           [](const auto& rig) { return rig.has_value(); });
    if (are_all_there || MonotonicClock::now() - *take.first_arrival > settings_.rig_wait)
        open(take);
}

void TakeRecorder::open(Take& take) {
    const std::filesystem::path folder = std::filesystem::absolute(take.path).parent_path();
    const double needed_mb_s =
        take.bytes_a_pulse * settings_.pulse_rate_hz / 1e6 + (settings_.has_sound ? sound_mb_s : 0);
    take.disk_mb_s = settings_.disk_mb_s(folder);
    if (take.disk_mb_s < disk_margin * needed_mb_s)
        fail(
            "cannot record {}: the disk of {} writes {:.1f} MB/s, and these rigs' frames need "
            "{:.1f}; record to a faster disk or ask for fewer frames",
            take.path.string(), folder.string(), take.disk_mb_s, disk_margin * needed_mb_s);
    const double free_mb = free_disk_mb(folder);
    if (free_mb < least_room_s * needed_mb_s)
        fail(
            "cannot record {}: the disk of {} has {:.0f} MB left, which is {:.1f} s of these "
            "rigs' frames; free some space",
            take.path.string(), folder.string(), free_mb, free_mb / needed_mb_s);
    TakeFacts facts;
    facts.pulse_rate_hz = settings_.pulse_rate_hz;
    facts.origin = *take.origin;
    facts.program = settings_.program;
    facts.tai_offset_s = take.tai_offset_s;
    facts.timecode = TimecodeClock(settings_.pulse_rate_hz).at(*take.origin, take.tai_offset_s);
    facts.show = take.stage.show;
    facts.show["calibrations"] = take.calibrations;
    facts.attachments = take.stage.attachments;
    facts.has_sound = settings_.has_sound;
    // A rig that comes later is assumed to send the same as the first one.
    const auto present = std::find_if(take.rigs.begin(), take.rigs.end(),
                                      [](const auto& rig) { return rig.has_value(); });
    for (std::size_t i = 0; i < take.rigs.size(); ++i) {
        facts.rigs.push_back(take.rigs[i].value_or(**present));
        facts.rigs.back().name = take.names[i];
    }
    take.writer.emplace(take.path, facts);
    for (std::size_t i = 0; i < facts.rigs.size(); ++i)
        take.storers[i] = std::make_unique<FrameStorer>(facts.rigs[i]);
    log_info("recording {}: {:.1f} MB/s, and the disk can write {:.0f}", take.path.string(),
             needed_mb_s, take.disk_mb_s);
    for (const SoundBlock& sound : std::exchange(take.held_sound, {})) hear(take, sound);
    const std::vector<Item> held = std::exchange(take.held, {});
    for (std::size_t i = 0; i < held.size(); i += most_frames_a_rig)
        store(take, std::span(held).subspan(i, std::min(most_frames_a_rig, held.size() - i)));
}

/// Encodes frames with one thread per rig, and writes them in the order of arrival. Hands over
/// earlier frames before waiting for one, so that a killed process loses only unencoded frames.
void TakeRecorder::store(Take& take, std::span<const Item> items) {
    std::vector<std::promise<StoredFrame>> coded(items.size());
    std::vector<std::future<StoredFrame>> coming;
    std::vector<std::vector<std::size_t>> of_rig(take.storers.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        coming.push_back(coded[i].get_future());
        if (items[i].frame) of_rig[items[i].frame->rig].push_back(i);
    }
    std::vector<std::future<void>> coders;
    for (std::size_t rig = 0; rig < of_rig.size(); ++rig) {
        if (of_rig[rig].empty()) continue;
        coders.push_back(std::async(std::launch::async, [&, rig] {
            for (const std::size_t i : of_rig[rig]) {
                try {
                    coded[i].set_value(take.storers[rig]->store(*items[i].frame->packed));
                } catch (...) {
                    coded[i].set_exception(std::current_exception());
                }
            }
        }));
    }
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].sound) hear(take, *items[i].sound);
        if (!items[i].frame) {
            if (!items[i].sound) {
                const Writing writing(*this);
                take.writer->add(items[i].camera);
            }
            continue;
        }
        if (coming[i].wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
            const Writing writing(*this);
            take.writer->hand_over();
        }
        std::optional<StoredFrame> stored;
        try {
            stored = coming[i].get();
        } catch (const Error& error) {
            refuse(take, *items[i].frame, error.what());
        }
        if (stored) write(take, *items[i].frame, std::move(*stored));
    }
}

void TakeRecorder::hear(Take& take, const SoundBlock& sound) {
    SoundBlock& waiting = take.sound;
    if (!waiting.samples.empty() && sound.first != waiting.end()) write_sound(take);
    if (waiting.samples.empty()) waiting.first = sound.first;
    waiting.samples.insert(waiting.samples.end(), sound.samples.begin(), sound.samples.end());
    if (waiting.count() >= sound_block) write_sound(take);
}

void TakeRecorder::write_sound(Take& take) {
    const Writing writing(*this);
    if (!take.sound.samples.empty()) take.writer->add(take.sound);
    take.sound.samples.clear();
}

void TakeRecorder::write(Take& take, const ArrivedFrame& frame, StoredFrame stored) {
    stored.record.arrival = frame.arrival_tai;
    stored.record.link = frame.link;
    {
        const std::lock_guard lock(mutex_);
        const TakeState::Rig& rig = state_.rigs[frame.rig];
        stored.record.dropped = rig.dropped + rig.refused;
    }
    const auto add = [&] {
        const Writing writing(*this);
        return take.writer->add(frame.rig, std::move(stored));
    };
    if (!add()) {
        refuse(take, frame, "its pulse is not later than that of the frame before it");
        return;
    }
    const std::lock_guard lock(mutex_);
    const MonotonicTime now = MonotonicClock::now();
    const std::chrono::nanoseconds unwritten = now - std::max(frame.arrival, asked_);
    take.longest_unwritten = std::max(take.longest_unwritten, unwritten);
    if (unwritten > long_unwritten && !std::exchange(take.is_lateness_told, true))
        log_warning(
            "{}: data is written {:.1f} s late and would be lost if this program were killed: {}",
            take.path.string(), std::chrono::duration<double>(unwritten).count(),
            is_disk_slow(now) ? "the disk is slow; record to a faster one"
                              : "the computer is overloaded");
    ++state_.rigs[frame.rig].frames;
}

void TakeRecorder::refuse(Take& take, const ArrivedFrame& frame, const std::string& why) {
    if (std::exchange(take.told[frame.rig], why) != why)
        log_warning("a frame of rig {} is missing from the take: {}", take.names[frame.rig], why);
    const std::lock_guard lock(mutex_);
    ++state_.rigs[frame.rig].refused;
}

void TakeRecorder::close(Take& take) {
    if (!take.writer) {
        if (take.held.empty() && !settings_.may_be_empty)
            fail("{} is not written: no frame came", take.path.string());
        if (!take.held.empty()) open(take);
    }
    if (take.writer) {
        write_sound(take);
        take.writer->finish();
    }
}

void TakeRecorder::note(Take& take) {
    const std::lock_guard lock(mutex_);
    state_.disk_mb_s = take.disk_mb_s;
    state_.longest_unwritten_ms = to_ms(take.longest_unwritten);
    round_arrival_.reset();
    if (!take.writer) return;
    syncing_since_ = take.writer->syncing_since();
    if (const std::string now = trouble(MonotonicClock::now());
        syncing_since_ && !now.empty() && !std::exchange(take.is_sync_told, true))
        log_warning("{}: {}; record to a faster one", take.path.string(), now);
    if (state_.phase == TakePhase::opening) state_.phase = TakePhase::recording;
    state_.frames = take.writer->frames();
    state_.gaps = take.writer->gaps();
    state_.bytes = take.writer->bytes();
    state_.duration_s = take.writer->duration_s();
    state_.sound_s = take.writer->sound_s();
    state_.mb_s =
        state_.duration_s > 0 ? static_cast<double>(state_.bytes) / 1e6 / state_.duration_s : 0;
}

}  // namespace vantage
