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

/// A side-by-side picture cut in the middle; the halves share its memory. Throws Error, naming
/// `what` it is, if its width is odd.
StereoPair split_side_by_side(const ColourImage& picture, const std::string& what);

/// Recorded stereo pictures: single ones, series, or videos.
class StereoMaterial {
  public:
    virtual ~StereoMaterial() = default;

    virtual cv::Size size() const = 0;  ///< of each picture of a pair
    /// Pictures a second as the material itself says; 0: it does not.
    virtual double rate_hz() const { return 0; }
    /// The pair for the pulse; empty at the end of material that does not loop. Pulses are asked
    /// for in rising order. Throws Error naming the file that is missing, damaged or of another
    /// size.
    virtual std::optional<StereoPair> pair_of(std::uint64_t pulse_index) = 0;
    /// Of material that has ended: pairs behind the last one shown, whose pulses were missed.
    virtual std::uint64_t unshown() const { return 0; }
    /// One line for the start-up report.
    virtual std::string describe() const = 0;
};

/// True for a folder, and for a shell pattern with * or ?.
bool is_list(const std::string& name);

/// Opens what [source] names with left, right, first and loop. Throws Error with the mend.
std::unique_ptr<StereoMaterial> open_material(const RigConfig::Source& source);

/// Pictures. Series (numbered ones, those that a shell pattern matches, those of a folder) that
/// loop are bound to the pulse, so that rigs which play the parts of one take show the same instant
/// whenever each was started: pulse k shows picture k modulo their number. Without looping the
/// first pulse shows the first picture. Pictures of missed pulses are left out.
std::unique_ptr<StereoMaterial> open_pictures(const RigConfig::Source& source);

/// A side-by-side video, or one a side, of any form that FFmpeg knows; the shorter of two ends a
/// round. Every pulse shows the next picture, so that
/// a computer that cannot decode at the pulses' rate plays it slower and does not fall behind for
/// ever.
std::unique_ptr<StereoMaterial> open_video(const RigConfig::Source& source);

}  // namespace vantage
