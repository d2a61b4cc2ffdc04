#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// A file name with one number in it, written as printf does: "left_%04d.png", "%d.jpg".
class NumberedFiles {
  public:
    static bool is_pattern(const std::filesystem::path& path);

    /// Throws Error unless the file name (not its folder) holds exactly one %d or %0Nd.
    explicit NumberedFiles(const std::filesystem::path& pattern);

    std::filesystem::path path(int number) const;

    /// How many files there are from `first` on. Throws Error if there is none, or if one is
    /// missing before the last.
    int count_from(int first) const;

  private:
    std::filesystem::path folder_;
    std::string before_, after_;
    int digits_ = 0;  ///< at least so many, filled up with zeros
};

}  // namespace vantage
