#pragma once

#include <filesystem>
#include <optional>

#include <gtest/gtest.h>

namespace vantage {

/// The folder with real stereo data: $VANTAGE_DATA, or shared/data beside the checkout; empty if
/// there is none.
std::optional<std::filesystem::path> data_folder();

/// A new folder for a test, removed at destruction.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace vantage

/// For the top of a test that needs real data: skips it with the reason if there is none.
#define VANTAGE_REQUIRE_DATA(variable)                                                          \
    const auto variable##_optional = ::vantage::data_folder();                                  \
    if (!variable##_optional)                                                                   \
        GTEST_SKIP() << "SKIPPED: no stereo data (set VANTAGE_DATA to the folder that has it)"; \
    const std::filesystem::path& variable = *variable##_optional
