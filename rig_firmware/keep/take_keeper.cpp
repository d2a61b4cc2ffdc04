#include "rig_firmware/keep/take_keeper.h"

#include <algorithm>
#include <ctime>
#include <vector>

#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/log.h"
#include "common/take/kept_files.h"

namespace vantage {
namespace {

constexpr std::chrono::milliseconds look_every{100};
/// A disk that failed is left alone for so long.
constexpr std::chrono::seconds patience_with_disk{10};
/// Of a disk that a file failed on: below this the oldest makes room.
constexpr double least_room_mb = 500;
/// What may come between the end of a file and the begin of the next.
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

}  // namespace

TakeKeeper::TakeKeeper(const RigConfig::Keep& config, std::string rig, double rate_hz)
    : config_(config), rig_(std::move(rig)), recorder_(recorder_settings(rig_, rate_hz)) {
    std::error_code error;
    std::filesystem::create_directories(config_.folder, error);
    if (error)
        fail("the folder {} of [keep] cannot be made: {}", config_.folder.string(),
             error.message());
    require_writable_output(config_.folder / kept_file_name(rig_, std::time(nullptr)), {});
    drop_oldest(false);
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
}

void TakeKeeper::offer(const std::shared_ptr<const PackedFrame>& frame) {
    if (frame->is_raw_pair) return;
    recorder_.offer(ArrivedFrame{0, frame, {}, MonotonicClock::now(), TaiClock::now()});
}

void TakeKeeper::begin() {
    recorder_.begin(free_path(config_.folder / kept_file_name(rig_, std::time(nullptr))));
}

void TakeKeeper::run() {
    const std::chrono::duration<double, std::ratio<60>> length(config_.minutes);
    MonotonicTime begun = MonotonicClock::now();
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            if (woken_.wait_for(lock, look_every, [&] { return is_stopping_; })) return;
        }
        const MonotonicTime now = MonotonicClock::now();
        const TakePhase phase = recorder_.state().phase;
        const bool has_failed = phase == TakePhase::failed;
        // Nothing is published, so there is nothing to end.
        if (phase == TakePhase::opening) begun = now;
        if (has_failed ? now - begun < patience_with_disk : now - begun < length) continue;
        try {
            recorder_.finish();
            drop_oldest(has_failed && free_disk_mb(config_.folder) < least_room_mb);
            begin();
        } catch (const Error& error) {
            log_error("what this rig keeps: {}", error.what());
        }
        begun = now;
    }
}

void TakeKeeper::drop_oldest(bool at_least_one) {
    std::vector<KeptFile> files = kept_files(config_.folder, rig_);
    std::uint64_t bytes = 0;
    for (const KeptFile& file : files) bytes += file.bytes;
    const auto oldest = std::filesystem::file_time_type::clock::now() -
                        std::chrono::duration_cast<std::chrono::seconds>(
                            std::chrono::duration<double, std::ratio<3600>>(config_.hours));
    while (!files.empty() &&
           (at_least_one || static_cast<double>(bytes) > 1e9 * config_.gigabytes ||
            files.front().written < oldest)) {
        std::error_code error;
        std::filesystem::remove(files.front().path, error);
        if (error) fail("{} cannot be removed: {}", files.front().path.string(), error.message());
        at_least_one = false;
        bytes -= files.front().bytes;
        files.erase(files.begin());
    }
    const std::lock_guard lock(mutex_);
    files_ = files.size();
    bytes_ = bytes;
}

std::string TakeKeeper::line() const {
    const TakeState state = recorder_.state();
    const std::lock_guard lock(mutex_);
    std::string text = fmt::format("keeps {:.1f} GB in {} files of {}, {:.1f} MB a second",
                                   static_cast<double>(bytes_ + state.bytes) / 1e9, files_ + 1,
                                   config_.folder.string(), state.mb_s);
    for (const TakeState::Rig& rig : state.rigs)
        if (rig.dropped > 0) text += fmt::format(", {} frames left out", rig.dropped);
    if (!state.failure.empty()) text += "; " + state.failure;
    return text;
}

}  // namespace vantage
