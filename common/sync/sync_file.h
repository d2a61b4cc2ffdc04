#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage {

/// What light said of one sensor's exposures, against those of the reference at the same pulses.
struct SensorSkew {
    std::string rig;
    bool is_left = true;
    double skew_ms = 0;      ///< of the exposures' centres; positive: later than the reference
    double sigma_ms = 0;     ///< one standard deviation of skew_ms
    double exposure_ms = 0;  ///< how long it exposes
    int pictures = 0;        ///< that the numbers rest on
    int strays = 0;          ///< more of them, a quarter of a pulse or more away from skew_ms
    int pulses_apart = 0;    ///< whole pulses in skew_ms, where it is within a quarter of one

    std::string name() const { return rig + (is_left ? " left" : " right"); }
};

/// A proof of a stage's synchronisation.
struct SyncRecord {
    std::string date;  ///< ISO 8601, UTC
    std::string tool;
    double rate_hz = 0;               ///< of the pulses
    double bar_step_ms = 0;           ///< of the bar that was seen
    std::string reference;            ///< name() of the sensor that the others are held against
    std::vector<SensorSkew> sensors;  ///< the reference among them

    /// The two sensors that are furthest apart, in ms. Precondition: there are sensors.
    double worst_ms() const;
};

/// Where a stage's proof is kept: stage.sync.yaml beside stage.toml.
std::filesystem::path sync_file_of(const std::filesystem::path& stage_file);

/// YAML that cv::FileStorage reads, with version, units, date and a checksum over the numbers.
/// Throws Error naming file and value for what is missing, damaged or of another version.
SyncRecord load_sync(const std::filesystem::path& path);

/// Writes atomically. A file that stood there before and is good is kept as PATH.last. Throws Error
/// if the disk refuses.
void save_sync(const std::filesystem::path& path, const SyncRecord& record);

}  // namespace vantage
