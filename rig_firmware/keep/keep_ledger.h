#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/take/kept_files.h"

namespace vantage {

/// The order and the age of the files that a rig keeps, in a file of its own beside them
/// (".NAME.keep.json"). Neither comes from the clock of the day, which may jump or not be set yet:
/// the order is a counter, and the age is the time for which this rig has kept takes since. One
/// thread.
class KeepLedger {
  public:
    struct Entry {
        std::string name;
        std::uint64_t number = 0;  ///< one more than the file before it
        double ended_s = 0;        ///< kept time at which the file ended
    };

    /// Reads what is there. One that cannot be read is begun anew, with a warning.
    KeepLedger(const std::filesystem::path& folder, const std::string& rig);

    /// Drops entries whose file is gone and counts files that have none: they are the newest, in
    /// the order of the list.
    void reconcile(const std::vector<KeptFile>& files);
    /// So much more time was spent keeping.
    void advance(double seconds) { kept_s_ += seconds; }
    /// Throws Error if it cannot be written.
    void save() const;

    /// The oldest first.
    const std::vector<Entry>& entries() const { return entries_; }
    double age_s(const Entry& entry) const { return kept_s_ - entry.ended_s; }

  private:
    std::filesystem::path path_;
    std::vector<Entry> entries_;
    double kept_s_ = 0;
};

}  // namespace vantage
