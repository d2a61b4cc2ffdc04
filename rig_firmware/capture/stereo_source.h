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

/// One instant seen by both sensors, not yet rectified.
struct StereoFrame {
    std::uint64_t trigger_index = 0;
    bool synchronized = false;  ///< trigger_index is a pulse of the stage
    TaiTime exposure{};         ///< centre of exposure
    MonotonicTime exposed{};    ///< the same moment, for durations: no clock that is set changes it
    ColourImage left, right;    ///< same size; grey sensors deliver equal channels
    /// The pictures in the cameras' own buffers, in place of `left` and `right`, which are empty
    /// then. Only from a source that was told to lend.
    std::optional<LentPicture> lent_left = {}, lent_right = {};
    DisparityImage exact_disparity;  ///< of the RECTIFIED left picture; only from the virtual
                                     ///< source for the matcher "exact", else empty
};

/// Something a source counts besides the instants it missed, e.g. "unpaired".
struct SourceCounter {
    std::string name;
    std::uint64_t count = 0;
};

/// The counter of camera pictures that were copied on their way to the GPU.
inline constexpr const char* copied_pictures = "copied_pictures";

/// Where a rig's pictures come from: the virtual stage, files, V4L2, libcamera. Made, used and
/// destroyed on one thread.
class StereoSource {
  public:
    virtual ~StereoSource() = default;

    /// Of each picture of every frame, before rectification.
    virtual cv::Size size() const = 0;

    /// Pictures a second as recorded material itself says; 0: it does not, or this is no recording.
    virtual double material_rate_hz() const { return 0; }

    /// Waits for the next instant; empty when the time is up, or at the end of the material. Throws
    /// Error when the source is broken beyond recovery.
    virtual std::optional<StereoFrame> next(std::chrono::nanoseconds timeout) = 0;

    /// True once there is nothing more to come: recorded material has an end, sensors have none.
    virtual bool ended() const { return false; }

    /// True if every picture is made when it is asked for. Such a source is asked only when there
    /// is room for its frame, so that a busy computer makes none for nothing; pulses that pass
    /// meanwhile are missed. Sensors are never made to wait.
    virtual bool works_on_demand() const { return false; }

    /// Pulses since the first frame for which none came (late, sequence gaps, unplugged).
    virtual std::uint64_t missed() const = 0;
    virtual std::vector<SourceCounter> counters() const { return {}; }

    /// Left and right, buffers such as its pictures would be lent in; empty where it cannot lend.
    /// What they show is no picture.
    virtual std::vector<LentPicture> specimens() const { return {}; }
    /// From now on pictures come lent as far as possible: no copy is made of them here. They have
    /// to be let go soon, for cameras have few buffers.
    virtual void lend() {}

    /// Sensors on a trigger ask it which pulse exposed a frame. It outlives the source; set before
    /// the first next().
    virtual void use(RigTrigger* /*trigger*/) {}
    /// How the sensors' clock runs by the stage's; empty where they have none of their own.
    virtual std::optional<ClockModel::State> clock() const { return std::nullopt; }

    /// Lines for the start-up report: device, mode, import path, locked controls.
    virtual std::vector<std::string> report() const = 0;
};

/// The name in [match] that stands for the source's own exact disparity, in place of a matcher.
inline constexpr const char* exact_matcher = "exact";

/// One registered kind of source: rig_firmware/capture/sources/KIND_source.cpp defines
/// KIND_source_entry().
struct SourceEntry {
    std::string kind;
    /// Without a calibration file its pictures are taken to come from the ideal rig of
    /// [virtual_rig].
    bool takes_ideal_rig = false;
    std::function<std::unique_ptr<StereoSource>(const RigConfig&)> make;
};
std::vector<SourceEntry> source_entries();

/// The entry of the config's kind; throws Error that lists the known kinds if it is none of them.
SourceEntry find_source(const RigConfig& config);

/// Throws Error also if the source cannot be had as the config wants it.
std::unique_ptr<StereoSource> make_source(const RigConfig& config);

}  // namespace vantage
