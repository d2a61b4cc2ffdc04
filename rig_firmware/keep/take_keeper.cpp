#include "rig_firmware/keep/take_keeper.h"

#include <algorithm>
#include <ctime>
#include <map>
#include <utility>
#include <vector>

#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/log.h"
#include "common/take/kept_files.h"

namespace vantage {
namespace {

constexpr std::chrono::milliseconds look_every{100};
/// Time without a new attempt after the disk has failed.
constexpr std::chrono::seconds patience_with_disk{10};
/// Free space of the disk below which the oldest file is erased.
constexpr double least_room_mb = 500;
/// A pulse index that is lower than the last one by more than this shows that the clock was set
/// back; frames without a pulse of their own may repeat an index.
constexpr std::uint64_t clock_step_pulses = 2;
/// Frames that can wait while the next file is opened. Beyond this number the oldest is dropped.
constexpr std::size_t most_held = 1000;
/// Longest expected gap between the end of a file and the start of the next one.
constexpr std::chrono::seconds between_files{30};

TakeRecorder::Settings recorder_settings(const std::string& rig, double rate_hz) {
    TakeRecorder::Settings settings;
    settings.rigs = {rig};
    settings.pulse_rate_hz = rate_hz;
    settings.program = fmt::format("vantage-rig {}", version());
    settings.show = nlohmann::ordered_json::object();
    settings.pre_roll = between_files;
    settings.may_be_empty = true;
    return settings;
}

void make_keep_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail("the folder {} of [keep] cannot be made: {}", folder.string(), error.message());
}

}  // namespace

TakeKeeper::TakeKeeper(const RigConfig::Keep& config, std::string rig, double rate_hz)
    : config_(config),
      rig_(std::move(rig)),
      ledger_((make_keep_folder(config_.folder), config_.folder), rig_),
      recorder_(recorder_settings(rig_, rate_hz)) {
    require_writable_output(config_.folder / kept_file_name(rig_, std::time(nullptr)), {});
    erase_oldest(false);
    begin();
    thread_ = std::thread([this] { run(); });
}

TakeKeeper::~TakeKeeper() {
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = true;
    }
    woken_.notify_all();
    thread_.join();
    recorder_.finish();
    try {
        ledger_.reconcile(kept_files(config_.folder, rig_));
        ledger_.save();
    } catch (const std::exception& error) {
        log_error("what this rig keeps: {}", error.what());
    }
}

void TakeKeeper::offer(const std::shared_ptr<const PackedFrame>& frame) {
    if (frame->is_raw_pair) return;
    {
        const std::lock_guard lock(mutex_);
        if (frame->trigger_index + clock_step_pulses < last_pulse_) pulses_went_back_ = true;
        last_pulse_ = frame->trigger_index;
        if (pulses_went_back_) {
            held_.push_back(frame);
            if (held_.size() > most_held) held_.pop_front();
            woken_.notify_all();
            return;
        }
    }
    recorder_.offer(ArrivedFrame{0, frame, {}, MonotonicClock::now(), TaiClock::now()});
}

void TakeKeeper::begin() {
    recorder_.begin(free_path(config_.folder / kept_file_name(rig_, std::time(nullptr))));
}

void TakeKeeper::run() {
    const std::chrono::duration<double, std::ratio<60>> length(config_.minutes);
    MonotonicTime begun = MonotonicClock::now(), looked = begun;
    for (;;) {
        bool pulses_go_back = false;
        {
            std::unique_lock lock(mutex_);
            woken_.wait_for(lock, look_every, [&] { return is_stopping_ || pulses_went_back_; });
            if (is_stopping_) return;
            pulses_go_back = pulses_went_back_;
        }
        const MonotonicTime now = MonotonicClock::now();
        ledger_.advance(std::chrono::duration<double>(now - std::exchange(looked, now)).count());
        const TakePhase phase = recorder_.state().phase;
        const bool has_failed = phase == TakePhase::failed;
        // Nothing is published, so there is no file to finish.
        if (phase == TakePhase::opening) begun = now;
        const bool is_due = has_failed ? now - begun >= patience_with_disk : now - begun >= length;
        if (!is_due && !pulses_go_back) continue;
        try {
            rotate(pulses_go_back);
        } catch (const Error& error) {
            log_error("what this rig keeps: {}", error.what());
            const std::lock_guard lock(mutex_);
            pulses_went_back_ = false;
            held_.clear();
        }
        begun = now;
    }
}

/// Finishes this file and starts the next one.
void TakeKeeper::rotate(bool pulses_go_back) {
    if (pulses_go_back)
        log_warning(
            "what this rig keeps: the pulses went back, as after a clock that was set back; the "
            "frames go on in another file");
    recorder_.finish();
    erase_oldest(free_disk_mb(config_.folder) < least_room_mb);
    begin();
    // The lock is held so that no newer frame is offered before these.
    const std::lock_guard lock(mutex_);
    for (const auto& frame : held_)
        recorder_.offer(ArrivedFrame{0, frame, {}, MonotonicClock::now(), TaiClock::now()});
    held_.clear();
    pulses_went_back_ = false;
}

void TakeKeeper::erase_oldest(bool disk_is_full) {
    const std::vector<KeptFile> files = kept_files(config_.folder, rig_);
    ledger_.reconcile(files);
    std::uint64_t bytes = 0;
    std::map<std::string, std::uint64_t> bytes_of;
    for (const KeptFile& file : files) {
        bytes += file.bytes;
        bytes_of[file.path.filename().string()] = file.bytes;
    }
    std::size_t left = files.size();
    constexpr double s_per_hour = 3600;
    for (const KeepLedger::Entry& oldest : ledger_.entries()) {
        std::string why;
        if (disk_is_full)
            why = fmt::format("its disk has less than {:g} MB left", least_room_mb);
        else if (static_cast<double>(bytes) > 1e9 * config_.gigabytes)
            why = fmt::format("all files together were larger than {:g} GB", config_.gigabytes);
        else if (ledger_.age_s(oldest) > s_per_hour * config_.hours)
            why = fmt::format("{:g} hours were kept since", config_.hours);
        if (why.empty()) break;
        const std::filesystem::path path = config_.folder / oldest.name;
        std::error_code error;
        std::filesystem::remove(path, error);
        if (error) fail("{} cannot be removed: {}", path.string(), error.message());
        const std::string sentence =
            fmt::format("{} ({:.1f} MB), since {}", oldest.name,
                        static_cast<double>(bytes_of[oldest.name]) / 1e6, why);
        log_info("what this rig keeps: erased {}", sentence);
        disk_is_full = false;
        bytes -= bytes_of[oldest.name];
        --left;
        const std::lock_guard lock(mutex_);
        ++erased_;
        last_erased_ = sentence;
    }
    ledger_.reconcile(kept_files(config_.folder, rig_));
    ledger_.save();
    const std::lock_guard lock(mutex_);
    files_ = left;
    bytes_ = bytes;
}

std::uint64_t TakeKeeper::erased() const {
    const std::lock_guard lock(mutex_);
    return erased_;
}

std::string TakeKeeper::line() const {
    const TakeState state = recorder_.state();
    const std::lock_guard lock(mutex_);
    std::string text = fmt::format("keeps {:.1f} GB in {} files of {}, {:.1f} MB a second",
                                   static_cast<double>(bytes_ + state.bytes) / 1e9, files_ + 1,
                                   config_.folder.string(), state.mb_s);
    for (const TakeState::Rig& rig : state.rigs)
        if (rig.dropped > 0) text += fmt::format(", {} frames left out", rig.dropped);
    if (erased_ > 0) text += fmt::format(", erased {} files, the last {}", erased_, last_erased_);
    if (!state.failure.empty()) text += "; " + state.failure;
    return text;
}

}  // namespace vantage
