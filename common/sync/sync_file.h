#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage {

/// The measured skew of one sensor's exposures from the reference sensor's at the same pulses.
struct SensorSkew {
    std::string rig;
    bool is_left = true;
    double skew_ms = 0;      ///< between exposure centres; positive: later than the reference
    double sigma_ms = 0;     ///< one standard deviation of skew_ms
    double exposure_ms = 0;  ///< exposure time
    int pictures = 0;        ///< number of frames that were measured
    int strays = 0;          ///< further frames, off by a quarter of a period or more from skew_ms
    int pulses_apart = 0;    ///< skew_ms in whole pulses, if within a quarter of one

    std::string name() const { return rig + (is_left ? " left" : " right"); }
};

/// The measured synchronisation of a stage.
struct SyncRecord {
    std::string date;  ///< ISO 8601, UTC
    std::string tool;
    double rate_hz = 0;               ///< trigger rate
    double bar_step_ms = 0;           ///< step of the LED bar
    std::string reference;            ///< name() of the reference sensor
    std::vector<SensorSkew> sensors;  ///< including the reference

    /// The largest skew between two sensors in ms. Precondition: there are sensors.
    double worst_ms() const;
};

/// The path of a stage's synchronisation file: stage.sync.yaml beside stage.toml.
std::filesystem::path sync_file_of(const std::filesystem::path& stage_file);

/// Loads a YAML file in the form of cv::FileStorage, with version, units, date and a checksum of
/// the numbers. Throws Error naming file and value for missing, damaged or unknown content.
SyncRecord load_sync(const std::filesystem::path& path);

/// Writes the file atomically; a valid earlier file is kept as PATH.last. Throws Error if it cannot
/// be written.
void save_sync(const std::filesystem::path& path, const SyncRecord& record);

}  // namespace vantage
