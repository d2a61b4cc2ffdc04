#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/image/image.h"
#include "rig_firmware/capture/lent_picture.h"
#include "rig_firmware/clock/clock_model.h"

namespace vantage {

struct RigConfig;
class RigTrigger;

/// One exposure of both sensors, not yet rectified.
struct StereoFrame {
    std::uint64_t trigger_index = 0;
    bool synchronized = false;  ///< trigger_index is a pulse of the stage
    TaiTime exposure{};         ///< centre of exposure
    MonotonicTime
        exposed{};  ///< the same moment on CLOCK_MONOTONIC, which is never set, for durations
    ColourImage left, right;  ///< same size; grey sensors deliver equal channels
    /// Images in the cameras' own buffers; `left` and `right` are empty then. Only from a source
    /// that was told to lend.
    std::optional<LentPicture> lent_left = {}, lent_right = {};
    DisparityImage exact_disparity;  ///< of the RECTIFIED left image; only from the virtual
                                     ///< source with the matcher "exact", else empty
};

/// Named counter of a source, besides the missed pulses, e.g. "unpaired".
struct SourceCounter {
    std::string name;
    std::uint64_t count = 0;
};

/// Name of the counter of camera images that were copied on their way to the GPU.
inline constexpr const char* copied_pictures = "copied_pictures";

/// Interface of a rig's image source: the virtual stage, files, V4L2 or libcamera. Create, use and
/// destroy it on one thread.
class StereoSource {
  public:
    virtual ~StereoSource() = default;

    /// Size of each image before rectification.
    virtual cv::Size size() const = 0;

    /// Frame rate that recorded material states, in frames per second; 0 if it states none or is
    /// not a recording.
    virtual double material_rate_hz() const { return 0; }

    /// Waits for the next stereo frame; empty after `timeout` or at the end of the material. Throws
    /// Error if the source cannot recover.
    virtual std::optional<StereoFrame> next(std::chrono::nanoseconds timeout) = 0;

    /// True at the end of recorded material; sensors never end.
    virtual bool ended() const { return false; }

    /// True if frames are made on request. The daemon then requests a frame only when there is room
    /// for it, so that a busy computer makes none in vain; pulses that pass in the meantime are
    /// missed. Sensors never have to wait.
    virtual bool works_on_demand() const { return false; }

    /// Number of pulses since the first frame that got no frame (late, sequence gaps, unplugged).
    virtual std::uint64_t missed() const = 0;
    virtual std::vector<SourceCounter> counters() const { return {}; }

    /// Sample buffers, left and right, of the kind that lent images come in; empty if the source
    /// cannot lend. Their content is undefined.
    virtual std::vector<LentPicture> specimens() const { return {}; }
    /// Lends images without a copy from now on, as far as possible. Release them soon, since
    /// cameras have few buffers.
    virtual void lend() {}

    /// Sets the trigger that tells which pulse exposed a frame. It outlives the source; call this
    /// before the first next().
    virtual void use(RigTrigger* /*trigger*/) {}
    /// Relation of the sensors' clock to the stage's clock; empty if they have no clock of their
    /// own.
    virtual std::optional<ClockModel::State> clock() const { return std::nullopt; }

    /// Lines for the start-up report: device, mode, import path, locked controls.
    virtual std::vector<std::string> report() const = 0;
};

/// Name in [match] for the source's own exact disparity, which replaces a matcher.
inline constexpr const char* exact_matcher = "exact";

/// Registry entry of a kind of source: rig_firmware/capture/sources/KIND_source.cpp defines
/// KIND_source_entry().
struct SourceEntry {
    std::string kind;
    /// without a calibration file, images are those of the ideal rig of [virtual_rig]
    bool takes_ideal_rig = false;
    std::function<std::unique_ptr<StereoSource>(const RigConfig&)> make;
};
std::vector<SourceEntry> source_entries();

/// Finds the entry of the configured kind. Throws Error that lists the known kinds.
SourceEntry find_source(const RigConfig& config);

/// Creates the configured source. Throws Error also if it is not available.
std::unique_ptr<StereoSource> make_source(const RigConfig& config);

}  // namespace vantage
