#include "host_app/output/contact_sheet_sink.h"

#include <fmt/format.h>

#include "common/image/image_file.h"
#include "host_app/output/media/contact_sheet.h"
#include "host_app/output/media/disparity_picture.h"

namespace vantage {
namespace {

constexpr std::size_t sheet_moments = 5;
constexpr int sheet_cell_px = 480;

SheetMoment row_of(const Moment& moment, std::size_t row) {
    SheetMoment stills{moment.title, {{moment.picture, "virtual view"}}};
    std::vector<const RigFrame*> frames;
    for (const FrameSet::Slot& slot : moment.set->slots)
        if (slot.frame && slot.frame->has_pictures()) frames.push_back(slot.frame.get());
    if (frames.empty()) return stills;
    // Each row shows another rig.
    const RigFrame& frame = *frames[row % frames.size()];
    stills.stills.push_back({frame.colour, fmt::format("{}: colour", frame.rig)});
    stills.stills.push_back(
        {disparity_picture(frame), fmt::format("{}: disparity, 0 (blue) to {:.0f} px (red)",
                                               frame.rig, frame.max_disparity_px)});
    return stills;
}

}  // namespace

ContactSheetSink::ContactSheetSink(std::filesystem::path path)
    : path_(std::move(path)), moments_(sheet_moments) {}

void ContactSheetSink::take(const ProgrammePicture& picture) {
    if (moments_.wants(picture.tick)) moments_.add({picture.title, picture.overlaid, picture.set});
}

void ContactSheetSink::finish() {
    std::vector<SheetMoment> rows;
    for (const Moment& moment : moments_.chosen()) rows.push_back(row_of(moment, rows.size()));
    if (rows.empty()) return;
    write_colour_image(
        path_, compose_contact_sheet("Vantage: flight of the virtual camera", rows, sheet_cell_px));
}

}  // namespace vantage
