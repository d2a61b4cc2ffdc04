#include "calib_tools/commands/snapshots.h"

#include <optional>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/calibration_file.h"

namespace vantage {
namespace {

LiveInstant film_one(const std::vector<RigFolder>& rigs, const LiveOption& live) {
    LiveRigs stage = live.connect(rigs);
    std::optional<LiveInstant> instant = stage.next_complete();
    if (!instant) fail("the program was ended before every rig had sent a picture");
    log_info("pulse {} from {} rigs", instant->pulse, rigs.size());
    return std::move(*instant);
}

}  // namespace

std::vector<RigSnapshot> take_snapshots(const std::vector<RigFolder>& rigs, const LiveOption& live,
                                        long long instant) {
    std::vector<RigSnapshot> snapshots;
    if (!live.given()) {
        for (const RigFolder& rig : rigs) {
            snapshots.push_back(load_snapshot(rig.name, rig.folder, instant));
            log_info("rig {}: rectified and matched", rig.name);
        }
        return snapshots;
    }
    std::vector<StereoCalibration> calibrations;
    for (const RigFolder& rig : rigs)
        calibrations.push_back(load_calibration(calibration_file_of(rig)));
    const LiveInstant filmed = film_one(rigs, live);
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        const RawPair& pair = *filmed.pairs[i];
        if (!pair.calibration_id.empty() && pair.calibration_id != calibrations[i].id)
            log_warning(
                "rig {} works with calibration {}, and {} is {}: install the file at the rig, or "
                "name the rig's own",
                rigs[i].name, pair.calibration_id, calibration_file_of(rigs[i]).string(),
                calibrations[i].id);
        snapshots.push_back(make_snapshot(rigs[i].name, calibrations[i], pair.left, pair.right));
        snapshots.back().calibration_date =
            load_calibration_record(calibration_file_of(rigs[i])).date;
        log_info("rig {}: rectified and matched", rigs[i].name);
    }
    return snapshots;
}

}  // namespace vantage
