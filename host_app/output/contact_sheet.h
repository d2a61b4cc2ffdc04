#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/image/image.h"
#include "common/receive/frame_set.h"
#include "host_app/output/picture_sink.h"

namespace vantage {

/// One image of a contact sheet with its caption.
struct SheetStill {
    ColourImage picture;
    std::string caption;
};

/// One row of a contact sheet: the images of one moment.
struct SheetRow {
    std::string title;
    std::vector<SheetStill> stills;
};

/// Composes a contact sheet: one row per moment, each still in a cell of `cell_width_px` with the
/// aspect ratio of the first still, scaled without distortion. Precondition: at least one moment,
/// and at least one still in each.
ColourImage compose_contact_sheet(const std::string& title, std::span<const SheetRow> moments,
                                  int cell_width_px);

/// Image of the virtual camera and its frame set at one moment of a flight.
struct FlightMoment {
    std::string title;
    ColourImage picture;                  ///< of the virtual camera
    std::shared_ptr<const FrameSet> set;  ///< the frame set that it was rendered from
};

/// Selects moments evenly over a flight of unknown length in bounded memory: it keeps every frame,
/// then every 2nd, every 4th and so on.
class MomentCollector {
  public:
    /// Precondition: wanted >= 2.
    explicit MomentCollector(std::size_t wanted) : wanted_(wanted) {}

    /// Frames count from 0.
    bool wants(std::uint64_t picture) const { return picture % stride_ == 0; }
    /// Precondition: wants(picture) is true, and all earlier wanted frames were added.
    void add(FlightMoment moment);

    /// At most `wanted` moments, evenly spaced, including the first and the newest one kept.
    std::vector<FlightMoment> chosen() const;

  private:
    std::size_t wanted_;
    std::uint64_t stride_ = 1;
    std::vector<FlightMoment> kept_;
};

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
