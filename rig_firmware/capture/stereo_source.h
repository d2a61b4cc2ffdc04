#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time.h"
#include "common/image/image.h"

namespace vantage {

struct RigConfig;

/// One instant seen by both sensors, not yet rectified.
struct StereoFrame {
    std::uint64_t trigger_index = 0;
    bool synchronized = false;       ///< trigger_index is a pulse of the stage
    TaiTime exposure{};              ///< centre of exposure
    ColourImage left, right;         ///< same size; grey sensors deliver equal channels
    DisparityImage exact_disparity;  ///< of the RECTIFIED left picture; only from the virtual
                                     ///< source, else empty
};

/// Where a rig's pictures come from: the virtual stage, files, V4L2, libcamera.
class StereoSource {
  public:
    virtual ~StereoSource() = default;

    /// Waits for the next instant; empty when the time is up. Throws Error when the source is at
    /// its end or broken beyond recovery.
    virtual std::optional<StereoFrame> next(std::chrono::nanoseconds timeout) = 0;

    /// Instants that should have come and did not (sequence gaps, missed pulses), since
    /// construction.
    virtual std::uint64_t missed() const = 0;

    /// Lines for the start-up report: device, mode, import path, locked controls.
    virtual std::vector<std::string> report() const = 0;
};

/// One registered kind of source: rig_firmware/capture/sources/KIND_source.cpp defines
/// KIND_source_entry().
struct SourceEntry {
    std::string kind;
    std::function<std::unique_ptr<StereoSource>(const RigConfig&)> make;
};
std::vector<SourceEntry> source_entries();

/// Throws Error that lists the known kinds if the config names none of them.
std::unique_ptr<StereoSource> make_source(const RigConfig& config);

}  // namespace vantage
