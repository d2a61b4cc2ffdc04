#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// A file name with one number in it, written as printf does: "left_%04d.png", "%d.jpg". Its folder
/// is taken as it is named.
class NumberedFiles {
  public:
    /// True for a name with '%' under which no file exists.
    static bool is_pattern(const std::filesystem::path& path);

    /// Throws Error unless the file name holds exactly one %d or %0Nd.
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
