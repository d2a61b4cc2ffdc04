#include "common/take/kept_frame.h"

#include "common/base/error.h"
#include "common/take/format/take_format.h"
#include "common/wire/frame_codec.h"
#include "common/wire/header_fields.h"
#include "common/wire/limits.h"

namespace vantage {
namespace {

constexpr std::size_t most_setup_bytes = 4096;

std::span<const char> chars_of(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::vector<std::byte> bytes_of(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

nlohmann::json to_json(const TakePictures& pictures) {
    nlohmann::json setup = nlohmann::json::array();
    for (const std::byte byte : pictures.setup) setup.push_back(std::to_integer<unsigned>(byte));
    return {{"codec", static_cast<int>(pictures.codec)},
            {"width_px", pictures.size_px.width},
            {"height_px", pictures.size_px.height},
            {"setup", std::move(setup)}};
}

TakePictures pictures_from(const nlohmann::json& json) {
    const auto number = [&](const nlohmann::json& value, int most) {
        if (!value.is_number_integer()) fail("its tracks have an invalid number");
        const auto found = value.get<std::int64_t>();
        if (found < 0 || found > most) fail("its tracks have {} where 0..{} is valid", found, most);
        return static_cast<int>(found);
    };
    TakePictures pictures;
    pictures.codec = static_cast<TakePictures::Codec>(
        number(json.at("codec"), static_cast<int>(TakePictures::Codec::ffv1)));
    pictures.size_px = {number(json.at("width_px"), max_picture_side_px),
                        number(json.at("height_px"), max_picture_side_px)};
    if (json.at("setup").size() > most_setup_bytes) fail("the setup of a track is too long");
    for (const nlohmann::json& byte : json.at("setup"))
        pictures.setup.push_back(static_cast<std::byte>(number(byte, 255)));
    if ((pictures.codec == TakePictures::Codec::none) != pictures.size_px.empty())
        fail("a track without images has a size, or one with images has none");
    return pictures;
}

void check_picture(const char* what, const TakePictures& track, const std::vector<std::byte>& bytes,
                   const std::optional<std::uint32_t>& crc) {
    if (crc.has_value() == bytes.empty() ||
        (!bytes.empty() && track.codec == TakePictures::Codec::none))
        fail("its {} is present although its record says otherwise, or missing", what);
    if (crc && crc32(bytes) != *crc) fail("its {} is damaged", what);
}

}  // namespace

KeptParts encode(const KeptFrame& kept) {
    const nlohmann::json head{{"rig", kept.rig.name},
                              {"pulse_rate_hz", kept.pulse_rate_hz},
                              {"tai_offset_s", kept.tai_offset_s},
                              {"colour", to_json(kept.rig.colour)},
                              {"depth", to_json(kept.rig.depth)}};
    return {kept.frame.record.pulse, bytes_of(head.dump()), bytes_of(to_text(kept.frame.record)),
            kept.frame.colour, kept.frame.depth};
}

KeptFrame decode_kept_frame(const KeptParts& parts) {
    if (parts.head.size() > most_text_bytes || parts.record.size() > most_text_bytes)
        fail("a kept frame came whose text is beyond the limit of {} bytes", most_text_bytes);
    KeptFrame kept;
    try {
        const std::span<const char> head = chars_of(parts.head);
        const nlohmann::json json = nlohmann::json::parse(head.begin(), head.end());
        kept.rig.name = json.at("rig").get<std::string>();
        check_name("rig", kept.rig.name);
        kept.pulse_rate_hz = json.at("pulse_rate_hz").get<double>();
        constexpr double least_hz = 0.001, most_hz = 1e6;
        if (!(kept.pulse_rate_hz >= least_hz && kept.pulse_rate_hz <= most_hz))
            fail("it has {} pulses per second", kept.pulse_rate_hz);
        if (!json.at("tai_offset_s").is_number_integer()) fail("its TAI offset is not a number");
        const auto offset = json.at("tai_offset_s").get<std::int64_t>();
        constexpr std::int64_t most_offset_s = 86'400;
        if (offset < -most_offset_s || offset > most_offset_s)
            fail("its TAI offset is {} s", offset);
        kept.tai_offset_s = static_cast<int>(offset);
        kept.rig.colour = pictures_from(json.at("colour"));
        kept.rig.depth = pictures_from(json.at("depth"));
    } catch (const nlohmann::json::exception&) {
        fail("a kept frame came whose head of {} bytes is damaged", parts.head.size());
    }
    const std::span<const char> record = chars_of(parts.record);
    kept.frame.record = frame_record_from({record.data(), record.size()});
    const FrameHead head = decode_frame_head(kept.frame.record.header);
    if (head.frame.rig != kept.rig.name || head.frame.trigger_index != kept.frame.record.pulse)
        fail("a kept frame came whose header is of rig {} and pulse {}, not of {} and {}",
             head.frame.rig, head.frame.trigger_index, kept.rig.name, kept.frame.record.pulse);
    check_picture("colour", kept.rig.colour, parts.colour, kept.frame.record.colour_crc);
    check_picture("disparity", kept.rig.depth, parts.depth, kept.frame.record.depth_crc);
    kept.frame.colour = parts.colour;
    kept.frame.depth = parts.depth;
    return kept;
}

}  // namespace vantage
