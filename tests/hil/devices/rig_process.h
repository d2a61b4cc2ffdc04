#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "common/wire/frame_message.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {

/// `vantage-rig run` as its own process, and this one as its host.
class RigProcess {
  public:
    /// `parts`: what its rig.toml says besides name and endpoint.
    explicit RigProcess(const std::string& parts);

    /// The next frame of it that comes; throws Error with the rig's log when none does.
    std::shared_ptr<const RigFrame> next_frame();
    /// What it said so far.
    std::string log() const { return program_->err(); }
    /// Ends it in order: its closing summary as JSON.
    std::string stop();
    /// After stop(): runs it again for the same host, with a log of its own.
    void start();

  private:
    std::filesystem::path config_file() const;

    TemporaryFolder folder_;
    std::unique_ptr<ChildProgram> program_;
    struct Receiver;
    std::shared_ptr<Receiver> receiver_;
};

}  // namespace vantage
