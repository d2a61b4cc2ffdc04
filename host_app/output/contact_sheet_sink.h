#pragma once

#include <filesystem>

#include "host_app/output/moment_collector.h"
#include "host_app/output/picture_sink.h"

namespace vantage {

/// Output that saves stills of the whole flight as one contact sheet: the virtual view, and the
/// colour and disparity of one rig.
class ContactSheetSink final : public PictureSink {
  public:
    explicit ContactSheetSink(std::filesystem::path path);

    std::string name() const override { return "contact sheet " + path_.string(); }
    void take(const ProgrammePicture& picture) override;
    /// Throws Error if the file cannot be written.
    void finish() override;

  private:
    std::filesystem::path path_;
    MomentCollector moments_;
};

}  // namespace vantage
