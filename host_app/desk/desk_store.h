#pragma once

#include <filesystem>

#include "common/base/files/kept_file.h"
#include "host_app/desk/desk_arrangement.h"

namespace vantage {

/// Keeps how hands have arranged the desk in a file beside the stage's or the take's; see KeptFile
/// for when it is written and what it replaces. Of the session's thread.
class DeskStore {
  public:
    /// Reads the file where there is one. Throws Error as load_desk().
    explicit DeskStore(std::filesystem::path file);

    /// What the session begins with.
    const DeskArrangement& desk() const { return desk_; }
    /// To be called often, with what there is now: writes what is due.
    void follow(const DeskArrangement& desk, MonotonicTime now);
    /// Writes all that is not written yet.
    void finish();

  private:
    KeptFile file_;
    DeskArrangement desk_;
};

/// STAGE.desk.toml beside STAGE.toml, TAKE.desk.toml beside TAKE.mkv.
std::filesystem::path desk_file_of(std::filesystem::path file);

}  // namespace vantage
