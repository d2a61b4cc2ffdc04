#pragma once

#include <filesystem>
#include <string>

#include "common/base/cli/reload_signal.h"
#include "common/config/stage_config.h"
#include "host_app/session/live_show.h"
#include "host_app/takes/take_control.h"

namespace vantage {

/// Lets a running show follow its changed stage file. Rigs that stay are not disturbed. An invalid
/// file changes nothing. Used on the session's thread.
class StageReload {
  public:
    /// `stage` is the configuration that the show began with. All referenced objects must outlive
    /// this one.
    StageReload(std::filesystem::path file, StageConfig stage, StageReceiver& receiver,
                TakeControl& takes, LiveShow& show);

    /// Reads the file and follows it. The result goes to the log and to LiveShow::note_reload().
    void reload();
    /// Reloads if the process was asked to by a signal.
    void follow(ReloadSignal& signal) {
        if (signal.take()) reload();
    }

  private:
    std::string follow_file();

    std::filesystem::path file_;
    StageConfig stage_;     ///< of the show
    std::string host_key_;  ///< its public key; empty: none
    StageReceiver& receiver_;
    TakeControl& takes_;
    LiveShow& show_;
    StageReloads reloads_;
};

}  // namespace vantage
