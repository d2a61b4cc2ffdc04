#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/data_folder.h"

namespace vantage {

/// A folder of shaders that a test writes and edits.
class ShaderFolder {
  public:
    const std::filesystem::path& path() const { return folder_.path(); }

    /// Every write is later than the one before, however coarse the file system's clock.
    void write(const std::string& name, const std::string& text) const {
        const auto file = path() / name;
        std::ofstream(file) << text;
        std::filesystem::last_write_time(file, std::filesystem::file_time_type(stamp_));
        stamp_ += std::chrono::seconds(2);
    }

  private:
    TemporaryFolder folder_;
    mutable std::filesystem::file_time_type::duration stamp_ = std::chrono::hours(1);
};

}  // namespace vantage
