#include "common/take/format/take_format.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

extern "C" {
#include <libavutil/base64.h>
#include <libavutil/crc.h>
}

#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "common/wire/limits.h"

namespace vantage {
namespace {

constexpr std::string_view crc_key = ",\"crc32\":\"";

std::string hex(std::uint32_t crc) { return fmt::format("{:08x}", crc); }

std::string base64(std::span<const std::byte> bytes) {
    std::string text(AV_BASE64_SIZE(bytes.size()), '\0');
    av_base64_encode(text.data(), static_cast<int>(text.size()),
                     reinterpret_cast<const std::uint8_t*>(bytes.data()),
                     static_cast<int>(bytes.size()));
    text.resize(text.size() - 1);
    return text;
}

std::vector<std::byte> from_base64(const std::string& text) {
    std::vector<std::byte> bytes(AV_BASE64_DECODE_SIZE(text.size()));
    const int size = bytes.empty() ? 0
                                   : av_base64_decode(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                                      text.c_str(), static_cast<int>(bytes.size()));
    if (size < 0) fail("a frame's record holds a header that is not base64");
    bytes.resize(static_cast<std::size_t>(size));
    return bytes;
}

std::string sealed(const nlohmann::ordered_json& json) {
    std::string text = json.dump();
    text.pop_back();
    return seal_record(std::move(text));
}

nlohmann::json unsealed(std::string_view text, std::string_view what) {
    const std::size_t at = text.rfind(crc_key);
    constexpr std::size_t digits = 8;
    if (at == std::string_view::npos || text.size() != at + crc_key.size() + digits + 2 ||
        text.substr(at + crc_key.size(), digits) !=
            hex(crc32(std::as_bytes(std::span(text.substr(0, at))))))
        fail("a {}'s record of {} bytes is damaged", what, text.size());
    nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) fail("a {}'s record of {} bytes is not JSON", what, text.size());
    return json;
}

/// Whether the JSON is a number that the type can hold.
template <class T, class Json>
bool is_number_of(const Json& json) {
    if constexpr (std::is_floating_point_v<T>)
        return json.is_number() && std::isfinite(json.template get<T>());
    else if (json.is_number_unsigned())
        return std::in_range<T>(json.template get<std::uint64_t>());
    else
        return json.is_number_integer() && std::in_range<T>(json.template get<std::int64_t>());
}

/// Reads a number; a missing one, or one of another type, makes the record invalid.
template <class T>
T number(const nlohmann::json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end() || !is_number_of<T>(*found))
        fail("a record has no valid number {}", key);
    return found->get<T>();
}

/// The same for take.json.
template <class T>
T fact(const nlohmann::ordered_json& json, const char* key) {
    const auto& value = json.at(key);
    if (!is_number_of<T>(value)) fail("its {} is not a valid number", key);
    return value.template get<T>();
}

std::optional<std::uint32_t> crc_of(const nlohmann::json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end()) return std::nullopt;
    return number<std::uint32_t>(json, key);
}

}  // namespace

std::uint32_t crc32(std::span<const std::byte> bytes) {
    constexpr std::uint32_t ones = 0xffffffff;
    return ones ^ av_crc(av_crc_get_table(AV_CRC_32_IEEE_LE), ones,
                         reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

std::int64_t TakeFacts::time_ms_of(TaiTime time) const {
    const std::int64_t since_ns = (time - origin).count();
    constexpr std::int64_t ns_a_ms = 1'000'000;
    return (since_ns + (since_ns >= 0 ? ns_a_ms / 2 : -ns_a_ms / 2)) / ns_a_ms;
}

std::int64_t TakeFacts::time_ms_of(const FrameRecord& record) const {
    return time_ms_of(record.is_synchronized ? PulseGrid(pulse_rate_hz).time_of(record.pulse)
                                             : record.exposure);
}

std::string seal_record(std::string text) {
    const std::uint32_t crc = crc32(std::as_bytes(std::span(text)));
    return text + std::string(crc_key) + hex(crc) + "\"}";
}

nlohmann::ordered_json to_json(const TakeFacts& facts) {
    nlohmann::ordered_json json{{"vantage_take", facts.has_sound ? take_version : 1},
                                {"program", facts.program},
                                {"pulse_rate_hz", facts.pulse_rate_hz},
                                {"origin_tai_ns", to_ns(facts.origin)},
                                {"timecode", facts.timecode},
                                {"tai_offset_s", facts.tai_offset_s},
                                {"disparity_step_px", 1.0 / 32},
                                {"unknown_disparity", 0}};
    for (const TakeRig& rig : facts.rigs) json["rigs"].push_back(rig.name);
    if (facts.has_sound) json["sound"] = {{"rate_hz", sound_rate_hz}, {"channels", sound_channels}};
    json["show"] = facts.show;
    return json;
}

TakeFacts take_facts_from(std::string_view text) {
    const auto json = nlohmann::ordered_json::parse(text, nullptr, false);
    try {
        TakeFacts facts;
        const int version = fact<int>(json, "vantage_take");
        if (version < 1 || version > take_version)
            fail("it is a take of version {}, and this program reads versions 1 to {}", version,
                 take_version);
        facts.program = json.at("program").get<std::string>();
        facts.pulse_rate_hz = fact<double>(json, "pulse_rate_hz");
        if (!(facts.pulse_rate_hz >= 0.001 && facts.pulse_rate_hz <= 1e6))
            fail("its pulse_rate_hz = {} is outside 0.001..1000000", facts.pulse_rate_hz);
        facts.origin = tai_from_ns(fact<std::int64_t>(json, "origin_tai_ns"));
        constexpr std::int64_t latest_ns = std::int64_t{1} << 62;
        if (to_ns(facts.origin) < 0 || to_ns(facts.origin) > latest_ns)
            fail("its origin of {} ns is not a valid time", to_ns(facts.origin));
        facts.timecode = json.at("timecode").get<std::string>();
        facts.tai_offset_s = fact<int>(json, "tai_offset_s");
        constexpr int most_offset_s = 1000;
        if (std::abs(facts.tai_offset_s) > most_offset_s)
            fail("its tai_offset_s = {} is beyond {}", facts.tai_offset_s, most_offset_s);
        for (const auto& rig : json.at("rigs")) {
            facts.rigs.emplace_back();
            facts.rigs.back().name = rig.get<std::string>();
        }
        facts.has_sound = json.contains("sound");
        if (facts.has_sound && (fact<int>(json.at("sound"), "rate_hz") != sound_rate_hz ||
                                fact<std::size_t>(json.at("sound"), "channels") != sound_channels))
            fail("its sound is not of {} channels at {} Hz", sound_channels, sound_rate_hz);
        facts.show = json.at("show");
        return facts;
    } catch (const nlohmann::json::exception&) {
        fail("its take.json was not written by Vantage");
    }
}

std::string to_text(const FrameRecord& record) {
    nlohmann::ordered_json json{{"pulse", record.pulse},
                                {"synchronized", record.is_synchronized},
                                {"exposure_tai_ns", to_ns(record.exposure)},
                                {"arrival_tai_ns", to_ns(record.arrival)},
                                {"gap", record.gap},
                                {"dropped", record.dropped},
                                {"session", record.session},
                                {"captured", record.rig.captured},
                                {"missed", record.rig.missed},
                                {"late", record.rig.late},
                                {"published", record.rig.published},
                                {"offered", record.link.offered},
                                {"sent", record.link.sent},
                                {"send_dropped", record.link.send_dropped},
                                {"thinned", record.link.skipped}};  // old name of the file format
    if (record.colour_crc) json["colour_crc32"] = *record.colour_crc;
    if (record.depth_crc) json["depth_crc32"] = *record.depth_crc;
    json["header"] = base64(record.header);
    return sealed(json);
}

FrameRecord frame_record_from(std::string_view text) {
    const nlohmann::json json = unsealed(text, "frame");
    FrameRecord record;
    record.pulse = number<std::uint64_t>(json, "pulse");
    if (record.pulse > max_trigger_index)
        fail("a frame's record names pulse {}, beyond {}", record.pulse, max_trigger_index);
    const auto synchronized = json.find("synchronized");
    const auto header = json.find("header");
    if (synchronized == json.end() || !synchronized->is_boolean() || header == json.end() ||
        !header->is_string())
        fail("a frame's record lacks a part");
    record.is_synchronized = synchronized->get<bool>();
    record.exposure = tai_from_ns(number<std::int64_t>(json, "exposure_tai_ns"));
    if (to_ns(record.exposure) < 0) fail("a frame's record has an exposure before 1970");
    record.arrival = tai_from_ns(number<std::int64_t>(json, "arrival_tai_ns"));
    record.gap = number<std::uint64_t>(json, "gap");
    record.dropped = number<std::uint64_t>(json, "dropped");
    record.session = number<std::uint64_t>(json, "session");
    record.rig = {number<std::uint64_t>(json, "captured"), number<std::uint64_t>(json, "missed"),
                  number<std::uint64_t>(json, "late"), number<std::uint64_t>(json, "published"), 0};
    record.link = {number<std::uint64_t>(json, "offered"), number<std::uint64_t>(json, "sent"),
                   number<std::uint64_t>(json, "send_dropped"),
                   number<std::uint64_t>(json, "thinned")};  // old name of the file format
    record.colour_crc = crc_of(json, "colour_crc32");
    record.depth_crc = crc_of(json, "depth_crc32");
    record.header = from_base64(header->get_ref<const std::string&>());
    return record;
}

std::string to_text(const SoundRecord& record) {
    return sealed({{"first_sample", record.first},
                   {"samples", record.count},
                   {"heard_tai_ns", to_ns(time_of_sound(record.first))},
                   {"sound_crc32", record.crc}});
}

SoundRecord sound_record_from(std::string_view text) {
    const nlohmann::json json = unsealed(text, "sound");
    SoundRecord record{number<std::int64_t>(json, "first_sample"),
                       number<std::uint32_t>(json, "samples"),
                       number<std::uint32_t>(json, "sound_crc32")};
    // Within the range of nanosecond times, and at most one second long.
    constexpr std::int64_t most = (std::int64_t{1} << 62) / nanoseconds_per_second * sound_rate_hz;
    if (record.first < 0 || record.first > most || record.count < 1 || record.count > sound_rate_hz)
        fail("a sound's record has an invalid range of samples");
    return record;
}

std::vector<std::byte> stored_sound(std::span<const float> samples) {
    constexpr float most = 8388607;
    std::vector<std::byte> bytes;
    bytes.reserve(3 * samples.size());
    for (const float sample : samples) {
        const auto value = static_cast<std::uint32_t>(static_cast<std::int32_t>(
            std::lround(std::clamp(sample * (most + 1), -most - 1, most))));
        for (const int shift : {0, 8, 16}) bytes.push_back(static_cast<std::byte>(value >> shift));
    }
    return bytes;
}

std::vector<float> sound_from_stored(std::span<const std::byte> bytes) {
    std::vector<float> samples(bytes.size() / 3);
    constexpr float whole = 1.0F / 2147483648.0F;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto byte = [&](std::size_t n) {
            return std::to_integer<std::uint32_t>(bytes[3 * i + n]);
        };
        const std::uint32_t value = byte(0) << 8 | byte(1) << 16 | byte(2) << 24;
        samples[i] = whole * static_cast<float>(static_cast<std::int32_t>(value));
    }
    return samples;
}

nlohmann::ordered_json pose_json(const Pose& pose) {
    nlohmann::ordered_json numbers;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) numbers.push_back(pose.matrix()(row, column));
    return numbers;
}

std::string to_text(const CameraRecord& record) {
    return sealed({{"tick", record.tick},
                   {"pulse", record.pulse},
                   {"time_tai_ns", to_ns(record.time)},
                   {"world_from_camera", pose_json(record.world_from_camera)},
                   {"field_of_view_rad", record.field_of_view_rad},
                   {"focus_m", record.focus_m}});
}

CameraRecord camera_record_from(std::string_view text) {
    const nlohmann::json json = unsealed(text, "camera");
    CameraRecord record;
    record.tick = number<std::uint64_t>(json, "tick");
    record.pulse = number<std::uint64_t>(json, "pulse");
    if (record.pulse > max_trigger_index)
        fail("a camera's record names pulse {}, beyond {}", record.pulse, max_trigger_index);
    record.time = tai_from_ns(number<std::int64_t>(json, "time_tai_ns"));
    if (to_ns(record.time) < 0) fail("a camera's record has a time before 1970");
    const auto pose = json.find("world_from_camera");
    if (pose == json.end() || !pose->is_array() || pose->size() != 12)
        fail("a camera's record has no pose of twelve numbers");
    for (int i = 0; i < 12; ++i) {
        const nlohmann::json& value = (*pose)[static_cast<std::size_t>(i)];
        if (!value.is_number()) fail("a camera's record has no pose of twelve numbers");
        record.world_from_camera.matrix()(i / 4, i % 4) = value.get<double>();
    }
    record.field_of_view_rad = number<double>(json, "field_of_view_rad");
    record.focus_m = number<double>(json, "focus_m");
    return record;
}

}  // namespace vantage
