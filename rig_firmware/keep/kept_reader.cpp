#include "rig_firmware/keep/kept_reader.h"

#include <algorithm>

#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"
#include "common/take/kept_files.h"
#include "common/take/kept_frame.h"

namespace vantage {
namespace {

/// Files that stay open. Their indexes take some megabytes each; two hosts fetch from two places at
/// once.
constexpr std::size_t most_open = 8;
/// Shortest time after which a growing file is read again.
constexpr std::chrono::seconds growing_file_period{1};
/// Tolerance between a file's name and its frames: names have whole seconds, frames wait before
/// they are written, and a clock may be set.
constexpr std::chrono::seconds clock_doubt{120};

std::chrono::nanoseconds since_1970(std::filesystem::file_time_type time) {
    return std::chrono::file_clock::to_sys(time).time_since_epoch();
}

}  // namespace

KeptReader::KeptReader(std::filesystem::path folder, std::string rig, double rate_hz)
    : folder_(std::move(folder)), rig_(std::move(rig)), rate_hz_(rate_hz) {}

std::shared_ptr<const TakeReader> KeptReader::open(const std::filesystem::path& path,
                                                   std::uint64_t bytes, std::uint64_t from) {
    const auto known = std::find_if(opened_.begin(), opened_.end(),
                                    [&](const Open& each) { return each.path == path; });
    const MonotonicTime now = MonotonicClock::now();
    if (known != opened_.end()) {
        const Open found = *known;
        const bool has_more = found.bytes != bytes && now - found.read > growing_file_period;
        const bool holds_it = found.take && !found.take->frames(0).empty() &&
                              found.take->frames(0).back().pulse >= from;
        opened_.erase(known);
        if (holds_it || !has_more) {
            opened_.push_front(found);
            return found.take;
        }
    }
    Open opened{path, bytes, nullptr, now};
    try {
        auto take = std::make_shared<const TakeReader>(path);
        if (take->facts().rigs.size() == 1 && take->facts().rigs[0].name == rig_)
            opened.take = std::move(take);
    } catch (const Error& error) {
        // A file that was just created has no header yet.
        log_info("what this rig keeps: {}", error.what());
    }
    opened_.push_front(opened);
    if (opened_.size() > most_open) opened_.pop_back();
    return opened.take;
}

std::shared_ptr<const KeptParts> KeptReader::first_of(std::uint64_t from, std::uint64_t to) {
    const PulseGrid pulses(rate_hz_);
    // Offset of the stage's clock from the system clock, which names the files.
    const std::chrono::nanoseconds ahead =
        TaiClock::now().time_since_epoch() - std::chrono::system_clock::now().time_since_epoch();
    const auto begin = pulses.time_of(from).time_since_epoch() - ahead - clock_doubt;
    const auto end = pulses.time_of(to).time_since_epoch() - ahead + clock_doubt;
    std::vector<KeptFile> files = kept_files(folder_, rig_);
    const auto begin_of = [&](const KeptFile& file) {
        return begin_of_kept_file(file.path, rig_).value_or(0);
    };
    std::stable_sort(files.begin(), files.end(), [&](const KeptFile& a, const KeptFile& b) {
        return begin_of(a) < begin_of(b);
    });
    for (const KeptFile& file : files) {
        if (since_1970(file.written) < begin || std::chrono::seconds(begin_of(file)) > end)
            continue;
        const std::shared_ptr<const TakeReader> take = open(file.path, file.bytes, from);
        if (!take || take->facts().pulse_rate_hz != rate_hz_) continue;
        const std::vector<TakeReader::Frame>& frames = take->frames(0);
        auto frame = std::lower_bound(frames.begin(), frames.end(), from,
                                      [](const TakeReader::Frame& each, std::uint64_t wanted) {
                                          return each.pulse < wanted;
                                      });
        for (; frame != frames.end() && frame->pulse < to; ++frame) {
            try {
                KeptFrame kept{take->facts().rigs[0], take->facts().pulse_rate_hz,
                               take->facts().tai_offset_s, take->load(0, *frame)};
                if (!kept.frame.record.is_synchronized) continue;
                return std::make_shared<const KeptParts>(encode(kept));
            } catch (const TakeDamaged& error) {
                log_warning("what this rig keeps: {}", error.what());
            }
        }
    }
    return nullptr;
}

}  // namespace vantage
