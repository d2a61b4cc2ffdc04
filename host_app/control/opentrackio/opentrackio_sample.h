#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "host_app/control/opentrackio/opentrackio_packet.h"
#include "host_app/flight/camera_state.h"
#include "host_app/ltc/smpte_code.h"

namespace vantage {

/// The part of an OpenTrackIO sample that flies a camera. OpenTrackIO's stage has z up and looks
/// along y: its x is the world's x, its y is -z, and its z is y.
struct OpentrackioCamera {
    std::optional<std::uint32_t> source;  ///< sourceNumber
    Pose world_from_camera = Pose::Identity();
    std::optional<double> focal_length_mm;
    std::optional<double> sensor_width_mm;
    std::optional<double> focus_m;
};
/// A camera, or a sentence about what is wrong with the sample.
struct OpentrackioCameraReading {
    std::optional<OpentrackioCamera> camera;
    std::string fault;
};
OpentrackioCameraReading read_opentrackio_sample(std::span<const std::byte> bytes,
                                                 OpentrackioEncoding encoding);

/// A sample of the virtual camera.
struct OpentrackioSample {
    CameraState camera;
    std::uint32_t source = 1;
    std::string source_id, sample_id;  ///< of the form urn:uuid:...
    int width_px = 0, height_px = 0;
    double sensor_width_mm = 36;
    PulseGrid::Fraction rate{};  ///< of the programme
    TaiTime time{};
    std::uint32_t sequence = 0;
    std::optional<SmpteCode> timecode;
    std::optional<bool> ptp_locked;  ///< empty: unknown
};
/// Writes all that Vantage knows, including the static part, so that receivers may join at any
/// time. Version 1.0.1 of the protocol.
std::vector<std::byte> write_opentrackio_sample(const OpentrackioSample& sample,
                                                OpentrackioEncoding encoding);

/// A UUID (RFC 9562, version 8) as a URN: `base` with `number` as its last 48 bits.
std::string uuid_urn(std::uint64_t base, std::uint64_t number);

}  // namespace vantage
