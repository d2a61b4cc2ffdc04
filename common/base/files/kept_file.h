#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"

namespace vantage {

/// A small text file that autosaves the operator's changes of a session, one second after the first
/// change. If another program changed the file meanwhile, that version is kept under a free name.
/// A failing disk is reported once and retried. Not thread-safe.
class KeptFile {
  public:
    /// Reads the file if it exists. `what`: its content, for messages: "shots and move". Throws
    /// Error if the file cannot be read.
    KeptFile(std::filesystem::path file, std::string what);

    const std::filesystem::path& path() const { return file_; }
    /// Whether the file existed when the session began.
    bool is_there() const { return is_there_; }

    void note_change();
    bool is_changed() const { return changed_.has_value(); }
    /// Whether it is time to write a change.
    bool is_due(MonotonicTime now) const;
    /// Writes the text over the file that this session read or wrote. `makes_room`: a reason to
    /// rename the existing file first; null: none. False if writing failed, which is logged.
    bool write(const std::string& text, const char* makes_room = nullptr);

    static constexpr std::size_t most_bytes = 1 << 20;

  private:
    void put_aside(const char* why) const;

    std::filesystem::path file_;
    std::string what_;
    bool is_there_;
    std::vector<std::byte> bytes_;          ///< last read or written by this session; empty: none
    std::optional<MonotonicTime> changed_;  ///< time of the first change not yet written
    bool has_failed_ = false;
};

}  // namespace vantage
