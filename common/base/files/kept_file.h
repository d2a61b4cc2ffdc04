#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"

namespace vantage {

/// A small text file in which a session keeps what hands change, a second after the first change. A
/// file that anybody else has changed meanwhile stays under a free name. A disk that fails is told
/// of once and tried again.
class KeptFile {
  public:
    /// Reads the file where there is one. `what` it keeps, for people: "shots and move". Throws
    /// Error if it cannot be read.
    KeptFile(std::filesystem::path file, std::string what);

    const std::filesystem::path& path() const { return file_; }
    /// There was one when the session began.
    bool is_there() const { return is_there_; }

    void note_change();
    bool is_changed() const { return changed_.has_value(); }
    /// What was changed is to be written now.
    bool is_due(MonotonicTime now) const;
    /// In place of what this session read or wrote, or, where that has to stay, beside it.
    /// `makes_room`: why it has to; null: it need not. False: it failed, which the log says.
    bool write(const std::string& text, const char* makes_room = nullptr);

    static constexpr std::size_t most_bytes = 1 << 20;

  private:
    void put_aside(const char* why) const;

    std::filesystem::path file_;
    std::string what_;
    bool is_there_;
    std::vector<std::byte> bytes_;          ///< that this session read or wrote; empty: none
    std::optional<MonotonicTime> changed_;  ///< and not written yet
    bool has_failed_ = false;
};

}  // namespace vantage
