#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/config/stage_config.h"
#include "common/receive/rig_status.h"
#include "common/wire/curve_keys.h"

namespace vantage {

/// Edits stage.toml for `vantage setup`: creates it, or adds rigs at its end and keeps the rest as
/// it is.
class StageFile {
  public:
    /// Throws Error for an existing but invalid file.
    explicit StageFile(std::filesystem::path file);

    const std::filesystem::path& path() const { return file_; }
    bool is_there() const { return is_there_; }
    /// The configuration; without rigs if the file does not exist.
    const StageConfig& config() const { return config_; }
    /// This host's keys, from the file that the stage names, or host.key beside it, which is
    /// created if missing.
    CurveKeys host_keys() const;

    /// Adds a rig and writes the file atomically. Throws Error if the result would be invalid.
    void add(const StageConfig::Rig& rig, double rate_hz);

  private:
    void write(const std::string& text);

    std::filesystem::path file_, key_file_;
    bool is_there_ = false;
    StageConfig config_;
};

/// A fault of a rig that `vantage setup` reports.
struct Finding {
    std::string rig;
    bool blocks = false;  ///< whether the rig contributes nothing because of it
    std::string what;
    std::string mend;  ///< the repair, unless `what` contains it
};

/// The findings by rig, in the stage's order. `stage_file`: for the commands in them.
std::vector<Finding> findings_of(const ReceiverStatus& status, const std::string& stage_file);

}  // namespace vantage
