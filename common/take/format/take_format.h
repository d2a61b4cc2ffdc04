#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/av/sound.h"
#include "common/base/time/time.h"
#include "common/wire/frame_message.h"

namespace vantage {

// The content of a take, a Matroska file. Each rig has a colour track (JPEG as it came, V_MJPEG;
// lossless colour as FFV1), a disparity track (16-bit FFV1) and a text track with a FrameRecord per
// frame. A further text track has a CameraRecord per tick of the programme. Times are milliseconds
// since the take's origin; a frame has the time of its pulse.

// A take with sound has a sound track (24 bits per value) and a text track with a SoundRecord per
// 0.1 s of sound. Their times are those at which the sound was heard.

/// The version of a take with sound; a take without sound has version 1.
inline constexpr int take_version = 2;

/// The largest valid head, record or name.
inline constexpr std::size_t most_text_bytes = 1 << 16;

/// A video track.
struct TakePictures {
    enum class Codec { none, jpeg, ffv1 };
    Codec codec = Codec::none;
    cv::Size size_px;
    std::vector<std::byte> setup;  ///< FFV1's header, stored with the track

    bool operator==(const TakePictures&) const = default;
};

struct FrameRecord;

struct TakeRig {
    std::string name;
    TakePictures colour, depth;

    bool operator==(const TakeRig&) const = default;
};

/// A Matroska attachment.
struct TakeAttachment {
    std::string name, mime_type;
    std::vector<std::byte> bytes;
};

/// The data in the head of a take.
struct TakeFacts {
    double pulse_rate_hz = 30;
    TaiTime origin{};  ///< time 0 of the file
    std::string program;
    std::string timecode;         ///< time code of the origin; empty: unknown
    int tai_offset_s = 0;         ///< of the rigs' clock from UTC
    nlohmann::ordered_json show;  ///< stage, calibrations and colour corrections, as the host
                                  ///< writes them
    std::vector<TakeRig> rigs;
    bool has_sound = false;
    std::vector<TakeAttachment> attachments;  ///< besides take.json, which holds the above

    /// Milliseconds since the origin; negative: before the take.
    std::int64_t time_ms_of(TaiTime time) const;
    /// The time of the frame's pulse, or of its exposure if it has no pulse.
    std::int64_t time_ms_of(const FrameRecord& record) const;
};
/// The content of the attachment take.json.
nlohmann::ordered_json to_json(const TakeFacts& facts);
/// Parses take.json. Rigs have their names only; the rest is in the tracks. Throws Error if it is
/// invalid or of a later version.
TakeFacts take_facts_from(std::string_view json);

/// The record of a frame.
struct FrameRecord {
    std::uint64_t pulse = 0;
    bool is_synchronized = true;  ///< false: `pulse` is the rig's own count
    std::uint64_t session = 0;    ///< of the rig's daemon
    TaiTime exposure{}, arrival{};
    std::uint64_t gap = 0;      ///< pulses without a frame of this rig just before
    std::uint64_t dropped = 0;  ///< received frames of this rig missing from the take so far
    RigCounters rig;
    LinkCounters link;
    std::optional<std::uint32_t> colour_crc, depth_crc;  ///< CRC-32 of the tracks' data
    std::vector<std::byte> header;  ///< as received: FrameHeader of frame.proto
};
/// One line of JSON that ends with its own CRC-32.
std::string to_text(const FrameRecord& record);
/// Throws Error if the text is damaged.
FrameRecord frame_record_from(std::string_view text);

/// The record of a programme tick: the camera's pose, and the pulse of the picture.
struct CameraRecord {
    std::uint64_t tick = 0, pulse = 0;
    TaiTime time{};
    Pose world_from_camera = Pose::Identity();
    double field_of_view_rad = 0, focus_m = 0;
};
/// The record of a block of sound.
struct SoundRecord {
    std::int64_t first = 0;   ///< number of the first sample, as in SoundBlock
    std::uint32_t count = 0;  ///< number of samples
    std::uint32_t crc = 0;    ///< CRC-32 of the track's data
};
std::string to_text(const SoundRecord& record);
/// Throws Error if the text is damaged.
SoundRecord sound_record_from(std::string_view text);
/// The size of a stored sample: 24 bits per value, little-endian.
inline constexpr std::size_t stored_sound_bytes = 3 * sound_channels;
std::vector<std::byte> stored_sound(std::span<const float> samples);
/// Precondition: complete samples.
std::vector<float> sound_from_stored(std::span<const std::byte> bytes);

/// Twelve numbers, row by row.
nlohmann::ordered_json pose_json(const Pose& pose);
std::string to_text(const CameraRecord& record);
CameraRecord camera_record_from(std::string_view text);

std::uint32_t crc32(std::span<const std::byte> bytes);
/// Completes a record, a JSON object without its last brace, with its CRC.
std::string seal_record(std::string text);

}  // namespace vantage
