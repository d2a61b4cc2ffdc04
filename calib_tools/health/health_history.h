#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib_tools/health/stage_health.h"

namespace vantage {

/// Earlier check: one line of the history file, {"version": 1, "date": ..., "measures": [{"what",
/// "rigs", "value", "verdict"}]}.
struct PastCheck {
    struct Value {
        std::string what, rigs, verdict;
        double value = 0;
    };
    std::string date;
    std::vector<Value> values;
};

/// Oldest first; empty if there is no such file. Throws Error with file and line if it is damaged.
std::vector<PastCheck> load_history(const std::filesystem::path& path);

/// Writes the past checks and this one, at most the last 1000. The file is replaced atomically.
void append_history(const std::filesystem::path& path, std::vector<PastCheck> past,
                    const PastCheck& present);

PastCheck past_check(const StageHealth& health, const std::string& date);

/// Past values of one measure, oldest first.
std::vector<double> values_of(const std::vector<PastCheck>& past, const HealthMeasure& measure);

}  // namespace vantage
