#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "calib_tools/sync/sensor_exposures.h"
#include "common/sync/sync_file.h"

namespace vantage {

/// One sensor's film of the bar, read.
struct SensorFilm {
    std::string rig;
    bool is_left = true;
    std::vector<std::uint64_t> pulses;  ///< of every picture
    SensorExposures seen;
};

/// Every sensor against the first: the difference of their exposures' centres at the pulses of
/// which both have a picture that could be read. The median says what is usual, the mean of what is
/// near it the skew; what is a quarter of a pulse or more away from it is counted as a stray.
/// Skews beyond half the bar's period look like smaller ones. Throws Error for a sensor that shares
/// fewer than fewest_pictures such pulses with the first.
std::vector<SensorSkew> skews_of(const std::vector<SensorFilm>& films, const SyncBar& bar,
                                 double rate_hz);

/// What of it is not well, a sentence each: sensors a pulse apart, pictures that stray, and skews
/// beyond the limit, against the reference and within each rig. None: all is well.
std::vector<std::string> sync_troubles(const SyncRecord& record, double limit_ms);

/// What is worth knowing besides: the bar is too coarse to hold sensors to the limit.
std::vector<std::string> sync_doubts(const SyncRecord& record, double limit_ms);

std::string describe(const SyncRecord& record);
nlohmann::ordered_json to_json(const SyncRecord& record);

}  // namespace vantage
