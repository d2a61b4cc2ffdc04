#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "calib_tools/sync/sensor_exposures.h"
#include "common/base/files/embedded_text.h"
#include "common/sync/sync_file.h"

namespace vantage {

/// Exposures read from one sensor's film of the bar.
struct SensorFilm {
    std::string rig;
    bool is_left = true;
    std::vector<std::uint64_t> pulses;  ///< of every image
    SensorExposures seen;
};

/// Skew of every sensor relative to the first: the difference of their exposure centres at the
/// pulses that both read. The median is the usual difference; the mean of the values near it is the
/// skew; values a quarter of a pulse or more away are counted as strays. Skews beyond half the
/// bar's period appear smaller. Throws Error for a sensor with fewer than fewest_pictures common
/// pulses with the first.
std::vector<SensorSkew> skews_of(const std::vector<SensorFilm>& films, const SyncBar& bar,
                                 double rate_hz);

/// Problems, one sentence each: sensors a pulse apart, stray images, and skews beyond the limit,
/// relative to the reference and within each rig. Empty if there are none.
std::vector<std::string> sync_troubles(const SyncRecord& record, double limit_ms);

/// Further warnings: the bar is too coarse to verify the limit.
std::vector<std::string> sync_doubts(const SyncRecord& record, double limit_ms);

std::string describe(const SyncRecord& record);
nlohmann::ordered_json to_json(const SyncRecord& record);

/// screen_bar.html: a page that counts on a screen instead of a bar, with 8 spots and one step per
/// refresh.
std::span<const EmbeddedText> screen_pages();

}  // namespace vantage
