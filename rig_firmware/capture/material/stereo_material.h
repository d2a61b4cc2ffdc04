#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/config/rig_config.h"
#include "common/image/image.h"

namespace vantage {

struct StereoPair {
    ColourImage left, right;  ///< same size
};

/// Splits a side-by-side image in the middle; the halves share its memory. Throws Error, with
/// `what` as the name of the image, if the width is odd.
StereoPair split_side_by_side(const ColourImage& picture, const std::string& what);

/// Recorded stereo images: single pairs, series or videos. Use it from one thread.
class StereoMaterial {
  public:
    virtual ~StereoMaterial() = default;

    virtual cv::Size size() const = 0;  ///< of each image of a pair
    /// Frame rate of the material in frames per second; 0 if it states none.
    virtual double rate_hz() const { return 0; }
    /// Returns the pair for a pulse; empty at the end of material that does not loop. Pulses come
    /// in ascending order. Throws Error with the file that is missing, damaged or of another size.
    virtual std::optional<StereoPair> pair_of(std::uint64_t pulse_index) = 0;
    /// Number of pairs after the last one shown, once the material has ended. Their pulses were
    /// missed.
    virtual std::uint64_t unshown() const { return 0; }
    /// One line for the start-up report.
    virtual std::string describe() const = 0;
};

/// True for a folder, and for a shell pattern with * or ?.
bool is_list(const std::string& name);

/// Opens the material of [source] (left, right, first and loop). Throws Error with the mend.
std::unique_ptr<StereoMaterial> open_material(const RigConfig::Source& source);

/// Opens images: a pair, numbered files, a shell pattern or a folder. A looping series is bound to
/// the pulse: pulse k shows image k modulo their number. Rigs that play parts of one take thus show
/// the same frame set, whenever each was started. Without looping, the first pulse shows the first
/// image. Images of missed pulses are skipped.
std::unique_ptr<StereoMaterial> open_pictures(const RigConfig::Source& source);

/// Opens one side-by-side video, or one video per side, in any format of FFmpeg; the shorter video
/// ends a round. As with images, pulse k of a looping video shows frame k modulo their number, and
/// without looping the first pulse shows the first frame. Frames of missed pulses are left out, up
/// to a key frame without decoding them. A computer that cannot decode at the pulse rate shows
/// fewer frames, later, and never another one than that of the pulse.
std::unique_ptr<StereoMaterial> open_video(const RigConfig::Source& source);

}  // namespace vantage
