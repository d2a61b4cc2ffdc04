#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/take/kept_files.h"

namespace vantage {

/// Stores the order and the age of the files that a rig records, in a file beside them
/// (".NAME.keep.json"). Neither depends on the time of day, whose clock may jump or not be set yet:
/// the order is a counter, and the age is the time that this rig has recorded since then, measured
/// by CLOCK_MONOTONIC. Use it from one thread.
class KeepLedger {
  public:
    struct Entry {
        std::string name;
        std::uint64_t number = 0;  ///< one more than the file before it
        double ended_s = 0;        ///< recorded time at which the file ended
    };

    /// Reads the ledger of `folder`. An unreadable ledger is replaced, with a warning.
    KeepLedger(const std::filesystem::path& folder, const std::string& rig);

    /// Removes entries whose file is gone and adds entries for new files, in the order of the list.
    void reconcile(const std::vector<KeptFile>& files);
    /// Adds to the recorded time.
    void advance(double seconds) { kept_s_ += seconds; }
    /// Writes the ledger. Throws Error if it cannot be written.
    void save() const;

    /// Entries, oldest first.
    const std::vector<Entry>& entries() const { return entries_; }
    double age_s(const Entry& entry) const { return kept_s_ - entry.ended_s; }

  private:
    std::filesystem::path path_;
    std::vector<Entry> entries_;
    double kept_s_ = 0;
};

}  // namespace vantage
