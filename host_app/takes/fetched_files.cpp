#include "host_app/takes/fetched_files.h"

#include <algorithm>

#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/timecode.h"
#include "common/take/kept_files.h"
#include "common/take/take_pulses.h"

namespace vantage {

FetchedFiles::FetchedFiles(std::filesystem::path folder, std::string rig,
                           nlohmann::ordered_json show)
    : folder_(std::move(folder)), rig_(std::move(rig)), show_(std::move(show)) {
    for (const KeptFile& file : kept_files(folder_, rig_)) {
        try {
            const std::vector<std::uint64_t> in_file = pulses_of_rig(TakeReader(file.path), rig_);
            there_.insert(there_.end(), in_file.begin(), in_file.end());
        } catch (const Error& error) {
            log_warning("{}: its frames are fetched again", error.what());
        }
    }
    std::sort(there_.begin(), there_.end());
}

FetchedFiles::~FetchedFiles() {
    try {
        finish();
    } catch (const Error& error) {
        log_error("{}", error.what());
    }
}

void FetchedFiles::add(const KeptFrame& frame) {
    if (writer_ && (writer_->facts().rigs.front() != frame.rig ||
                    writer_->facts().pulse_rate_hz != frame.pulse_rate_hz ||
                    frame.frame.record.pulse <= last_pulse_))
        finish();
    if (!writer_) begin(frame);
    if (!writer_->add(0, frame.frame))
        fail("the frame of pulse {} of rig {} does not fit {}", frame.frame.record.pulse, rig_,
             writer_->path().string());
    last_pulse_ = frame.frame.record.pulse;
    writer_->flush_if_due();
}

void FetchedFiles::begin(const KeptFrame& frame) {
    TakeFacts facts;
    facts.pulse_rate_hz = frame.pulse_rate_hz;
    facts.origin = PulseGrid(frame.pulse_rate_hz).time_of(frame.frame.record.pulse);
    facts.program = fmt::format("vantage {}", version());
    facts.tai_offset_s = frame.tai_offset_s;
    facts.timecode = TimecodeClock(frame.pulse_rate_hz).at(facts.origin, frame.tai_offset_s);
    facts.show = show_;
    facts.rigs = {frame.rig};
    const auto utc = std::chrono::floor<std::chrono::seconds>(facts.origin.time_since_epoch()) -
                     std::chrono::seconds(frame.tai_offset_s);
    const std::filesystem::path path =
        free_path(folder_ / kept_file_name(rig_, static_cast<std::time_t>(utc.count())));
    writer_ = std::make_unique<TakeWriter>(path, facts);
    files_.push_back(path);
}

void FetchedFiles::finish() {
    if (!writer_) return;
    writer_->finish();
    writer_.reset();
}

}  // namespace vantage
