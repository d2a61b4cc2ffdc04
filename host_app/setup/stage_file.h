#pragma once

#include <filesystem>
#include <string>

#include "common/config/stage_config.h"
#include "common/wire/curve_keys.h"

namespace vantage {

/// stage.toml as `vantage setup` writes it: made where there is none, and else given rigs at its
/// end, with all that stands there left as it is.
class StageFile {
  public:
    /// Throws Error for one that is there and cannot be.
    explicit StageFile(std::filesystem::path file);

    const std::filesystem::path& path() const { return file_; }
    bool is_there() const { return is_there_; }
    /// Without rigs if it is not there.
    const StageConfig& config() const { return config_; }
    /// This host's own, of the file that the stage names, else host.key beside it; made and written
    /// where there is none.
    CurveKeys host_keys() const;

    /// Adds a rig, whole or not at all. Throws Error for what would make the file one that cannot
    /// be.
    void add(const StageConfig::Rig& rig, double rate_hz);

  private:
    void write(const std::string& text);

    std::filesystem::path file_, key_file_;
    bool is_there_ = false;
    StageConfig config_;
};

}  // namespace vantage
