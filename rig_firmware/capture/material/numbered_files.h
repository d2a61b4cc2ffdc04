#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// File name pattern with one number in printf's notation: "left_%04d.png", "%d.jpg". The folder is
/// not a pattern.
class NumberedFiles {
  public:
    /// True for a name with '%' that is not an existing file.
    static bool is_pattern(const std::filesystem::path& path);

    /// Throws Error unless the file name holds exactly one %d or %0Nd.
    explicit NumberedFiles(const std::filesystem::path& pattern);

    std::filesystem::path path(int number) const;

    /// Number of files from `first` on. Throws Error if there is none, or if one before the last is
    /// missing.
    int count_from(int first) const;

  private:
    std::filesystem::path folder_;
    std::string before_, after_;
    int digits_ = 0;  ///< smallest number of digits, with leading zeros
};

}  // namespace vantage
