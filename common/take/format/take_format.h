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

// What a take holds. It is a Matroska file: for every rig a track of colour (the JPEG as it came,
// V_MJPEG; lossless colour as FFV1) and one of disparity (FFV1 of 16 bits), for every rig a track
// of text with a FrameRecord a frame, and one with a CameraRecord a tick of the programme. Times
// are milliseconds since the take's origin, and those of a frame are its pulse's.

// A take with sound has a track of it, 24 bits a sample as they were heard, and one of text with a
// SoundRecord for every tenth of a second of it; their times are those at which it was heard.

/// Of a take with sound; one without is of version 1, as before there was any.
inline constexpr int take_version = 2;

/// A head, a record or a name that is longer is none of Vantage's.
inline constexpr std::size_t most_text_bytes = 1 << 16;

/// A track of pictures.
struct TakePictures {
    enum class Codec { none, jpeg, ffv1 };
    Codec codec = Codec::none;
    cv::Size size_px;
    std::vector<std::byte> setup;  ///< FFV1's own header; the file keeps it with the track

    bool operator==(const TakePictures&) const = default;
};

struct FrameRecord;

struct TakeRig {
    std::string name;
    TakePictures colour, depth;

    bool operator==(const TakeRig&) const = default;
};

/// A file inside the file.
struct TakeAttachment {
    std::string name, mime_type;
    std::vector<std::byte> bytes;
};

/// What is told once, at the head.
struct TakeFacts {
    double pulse_rate_hz = 30;
    TaiTime origin{};  ///< of the file's times
    std::string program;
    std::string timecode;         ///< the house's, of the origin; empty: not known
    int tai_offset_s = 0;         ///< of the rigs' clock from UTC
    nlohmann::ordered_json show;  ///< the stage, calibrations and colours, as the host writes them
    std::vector<TakeRig> rigs;
    bool has_sound = false;
    std::vector<TakeAttachment> attachments;  ///< beside take.json, which holds the above

    /// In the file: milliseconds since the origin. Negative: before the take.
    std::int64_t time_ms_of(TaiTime time) const;
    /// That of the frame's pulse, or of its exposure where that names none.
    std::int64_t time_ms_of(const FrameRecord& record) const;
};
/// As the attachment take.json.
nlohmann::ordered_json to_json(const TakeFacts& facts);
/// What take.json says; rigs have their names only, the rest is the tracks'. Throws Error if it is
/// none, or of a later version than this program reads.
TakeFacts take_facts_from(std::string_view json);

/// What is told of every frame.
struct FrameRecord {
    std::uint64_t pulse = 0;
    bool is_synchronized = true;  ///< false: `pulse` is the rig's own count
    std::uint64_t session = 0;    ///< of the rig's daemon
    TaiTime exposure{}, arrival{};
    std::uint64_t gap = 0;      ///< pulses without a frame of this rig right before
    std::uint64_t dropped = 0;  ///< frames of this rig that came and the take has not, so far
    RigCounters rig;
    LinkCounters link;
    std::optional<std::uint32_t> colour_crc, depth_crc;  ///< CRC-32 of what the tracks hold
    std::vector<std::byte> header;                       ///< as it came: FrameHeader of frame.proto
};
/// One line of JSON that ends with its own CRC-32.
std::string to_text(const FrameRecord& record);
/// Throws Error if the text is damaged.
FrameRecord frame_record_from(std::string_view text);

/// What is told of every tick of the programme: where its camera was, and of which pulse its
/// picture.
struct CameraRecord {
    std::uint64_t tick = 0, pulse = 0;
    TaiTime time{};
    Pose world_from_camera = Pose::Identity();
    double field_of_view_rad = 0, focus_m = 0;
};
/// What is told of a piece of sound.
struct SoundRecord {
    std::int64_t first = 0;   ///< sample, counted as those of SoundBlock
    std::uint32_t count = 0;  ///< samples
    std::uint32_t crc = 0;    ///< CRC-32 of what the track holds
};
std::string to_text(const SoundRecord& record);
/// Throws Error if the text is damaged.
SoundRecord sound_record_from(std::string_view text);
/// As the track holds it: 24 bits a value, the lowest byte first.
inline constexpr std::size_t stored_sound_bytes = 3 * sound_channels;
std::vector<std::byte> stored_sound(std::span<const float> samples);
/// Precondition: whole samples.
std::vector<float> sound_from_stored(std::span<const std::byte> bytes);

/// Twelve numbers, row after row.
nlohmann::ordered_json pose_json(const Pose& pose);
std::string to_text(const CameraRecord& record);
CameraRecord camera_record_from(std::string_view text);

std::uint32_t crc32(std::span<const std::byte> bytes);
/// Ends the text of a record, a JSON object without its last brace, as the two above do.
std::string seal_record(std::string text);

}  // namespace vantage
