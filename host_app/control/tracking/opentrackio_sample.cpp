#include "host_app/control/tracking/opentrackio_sample.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_app/flight/orbit_view.h"

namespace vantage {
namespace {

constexpr std::string_view identifier = "OTrk";
constexpr std::size_t encoding_at = 5, sequence_at = 6, offset_at = 8, length_at = 12,
                      checksum_at = 14;
constexpr std::uint16_t last_flag = 0x8000;
constexpr std::size_t most_senders = 8;

void put_number(std::byte* at, std::size_t bytes, std::uint32_t value) {
    for (std::size_t i = 0; i < bytes; ++i)
        at[i] = static_cast<std::byte>(value >> (8 * (bytes - 1 - i)) & 0xff);
}

std::uint32_t number_at(const std::byte* at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
        value = value << 8 | std::to_integer<std::uint32_t>(at[i]);
    return value;
}

using Json = nlohmann::json;

constexpr double degree = std::numbers::pi / 180;
constexpr int most_nesting = 16;
constexpr double most_metres = 1e6;

/// The change of axes between OpenTrackIO's (x right, y forward, z up) and those of the world (x
/// right, y up, z backward); the same matrix changes those of the camera (x right, y down, z
/// forward).
Eigen::Matrix3d changed_axes() {
    Eigen::Matrix3d axes;
    axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    return axes;
}

/// Checks a sample's syntax and nesting, since the library reads CBOR recursively.
class NestingCheck final : public nlohmann::json_sax<Json> {
  public:
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return ++depth_ <= most_nesting; }
    bool key(string_t&) override { return true; }
    bool end_object() override { return --depth_ >= 0; }
    bool start_array(std::size_t) override { return ++depth_ <= most_nesting; }
    bool end_array() override { return --depth_ >= 0; }
    bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
        return false;
    }

  private:
    int depth_ = 0;
};

std::optional<Json> parsed(std::span<const std::byte> bytes, OpentrackioEncoding encoding) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
    const auto* end = begin + bytes.size();
    const bool is_cbor = encoding == OpentrackioEncoding::cbor;
    NestingCheck check;
    if (!Json::sax_parse(begin, end, &check,
                         is_cbor ? Json::input_format_t::cbor : Json::input_format_t::json))
        return std::nullopt;
    Json json =
        is_cbor ? Json::from_cbor(begin, end, true, false) : Json::parse(begin, end, {}, false);
    if (!json.is_object()) return std::nullopt;
    return json;
}

/// The object in `json` with this name; an empty one where there is none.
const Json& part(const Json& json, const char* name) {
    static const Json none = Json::object();
    const auto found = json.find(name);
    return found != json.end() && found->is_object() ? *found : none;
}

std::optional<double> number(const Json& json, const char* name) {
    const auto found = json.find(name);
    if (found == json.end() || !found->is_number()) return std::nullopt;
    const double value = found->get<double>();
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// The number, 0 where it is left out; empty if it is there and no number.
std::optional<double> number_or_0(const Json& json, const char* name) {
    return json.contains(name) ? number(json, name) : 0;
}

std::optional<Eigen::Vector3d> vector(const Json& json, const char* x, const char* y,
                                      const char* z) {
    const auto a = number_or_0(json, x), b = number_or_0(json, y), c = number_or_0(json, z);
    if (!a || !b || !c) return std::nullopt;
    return Eigen::Vector3d(*a, *b, *c);
}

/// The pose that the list of transforms gives, in OpenTrackIO's axes. Empty if one has no numbers.
std::optional<Pose> composed(const Json& transforms) {
    Pose pose = Pose::Identity();
    Eigen::Vector3d scale(1, 1, 1);
    for (const Json& transform : transforms) {
        if (!transform.is_object()) return std::nullopt;
        const auto at = vector(part(transform, "translation"), "x", "y", "z");
        const auto turn_deg = vector(part(transform, "rotation"), "pan", "tilt", "roll");
        if (!at || !turn_deg) return std::nullopt;
        pose.translation() += pose.linear() * scale.cwiseProduct(*at);
        const Eigen::Vector3d turn = *turn_deg * degree;
        pose.linear() = pose.linear() *
                        Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                        Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitX()).toRotationMatrix() *
                        Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitY()).toRotationMatrix();
        const Json& scales = part(transform, "scale");
        for (int i = 0; i < 3; ++i)
            scale[i] *=
                number(scales, std::array{"x", "y", "z"}[static_cast<std::size_t>(i)]).value_or(1);
    }
    if (!(pose.translation().cwiseAbs().maxCoeff() < most_metres) || !pose.linear().allFinite())
        return std::nullopt;
    return pose;
}

std::optional<double> positive(const Json& json, const char* name) {
    const std::optional<double> value = number(json, name);
    return value && *value > 0 ? value : std::nullopt;
}

Json fraction(const PulseGrid::Fraction& rate) {
    return {{"num", rate.pulses}, {"denom", rate.seconds}};
}

Json timing(const OpentrackioSample& sample) {
    const std::int64_t ns = to_ns(sample.time);
    Json json{
        {"mode", "internal"},
        {"sampleRate", fraction(sample.rate)},
        {"sampleTimestamp",
         {{"seconds", ns / nanoseconds_per_second}, {"nanoseconds", ns % nanoseconds_per_second}}},
        {"sequenceNumber", sample.sequence}};
    if (sample.timecode)
        json["timecode"] = {
            {"hours", sample.timecode->hours},     {"minutes", sample.timecode->minutes},
            {"seconds", sample.timecode->seconds}, {"frames", sample.timecode->frame},
            {"frameRate", fraction(sample.rate)},  {"dropFrame", sample.timecode->is_drop_frame}};
    if (sample.ptp_locked)
        json["synchronization"] = {{"locked", *sample.ptp_locked}, {"source", "ptp"}};
    return json;
}

}  // namespace

std::uint16_t opentrackio_checksum(std::span<const std::byte> header,
                                   std::span<const std::byte> segment) {
    unsigned first = 0, second = 0;
    for (const std::span<const std::byte> part : {header, segment})
        for (const std::byte byte : part) {
            first = (first + std::to_integer<unsigned>(byte)) & 0xff;
            second = (second + first) & 0xff;
        }
    return static_cast<std::uint16_t>(second << 8 | first);
}

std::vector<std::vector<std::byte>> opentrackio_packets(std::span<const std::byte> sample,
                                                        OpentrackioEncoding encoding,
                                                        std::uint16_t sequence,
                                                        std::size_t segment_bytes) {
    std::vector<std::vector<std::byte>> packets;
    for (std::size_t at = 0; at < sample.size(); at += segment_bytes) {
        const std::size_t size = std::min(segment_bytes, sample.size() - at);
        std::vector<std::byte> packet(opentrackio_header_bytes);
        std::ranges::transform(identifier, packet.begin(),
                               [](char c) { return static_cast<std::byte>(c); });
        packet[encoding_at] = static_cast<std::byte>(encoding);
        put_number(&packet[sequence_at], 2, sequence);
        put_number(&packet[offset_at], 4, static_cast<std::uint32_t>(at));
        const bool is_last = at + size == sample.size();
        put_number(&packet[length_at], 2,
                   static_cast<std::uint32_t>(size) | (is_last ? last_flag : 0u));
        const std::span segment = sample.subspan(at, size);
        put_number(&packet[checksum_at], 2,
                   opentrackio_checksum(std::span(packet).first(checksum_at), segment));
        packet.insert(packet.end(), segment.begin(), segment.end());
        packets.push_back(std::move(packet));
    }
    return packets;
}

OpentrackioReading read_opentrackio_packet(std::span<const std::byte> datagram) {
    if (datagram.size() < opentrackio_header_bytes)
        return {{},
                fmt::format("{} bytes, where the header of OpenTrackIO alone has {}",
                            datagram.size(), opentrackio_header_bytes)};
    if (!std::equal(identifier.begin(), identifier.end(), datagram.begin(),
                    [](char c, std::byte byte) { return static_cast<std::byte>(c) == byte; }))
        return {{}, "a datagram that does not begin with OTrk, as those of OpenTrackIO do"};
    const std::uint32_t length = number_at(&datagram[length_at], 2);
    const std::span segment = datagram.subspan(opentrackio_header_bytes);
    if ((length & ~std::uint32_t{last_flag}) != segment.size())
        return {{},
                fmt::format("an OpenTrackIO packet with {} bytes behind its header, which says {}",
                            segment.size(), length & ~std::uint32_t{last_flag})};
    const std::uint32_t told = number_at(&datagram[checksum_at], 2);
    if (const std::uint16_t sum = opentrackio_checksum(datagram.first(checksum_at), segment);
        sum != told)
        return {{},
                fmt::format("an OpenTrackIO packet with the checksum 0x{:04x}, where its bytes "
                            "give 0x{:04x}",
                            told, sum)};
    const auto encoding = std::to_integer<unsigned>(datagram[encoding_at]);
    if (encoding != 1 && encoding != 2)
        return {{},
                fmt::format("an OpenTrackIO packet with the encoding {}; Vantage reads 1 (JSON) "
                            "and 2 (CBOR)",
                            encoding)};
    const std::uint32_t offset = number_at(&datagram[offset_at], 4);
    if (segment.empty() || offset + segment.size() > most_opentrackio_bytes)
        return {{},
                fmt::format("an OpenTrackIO sample of {} bytes; Vantage reads 1 to {}",
                            offset + segment.size(), most_opentrackio_bytes)};
    return {OpentrackioPacket{static_cast<OpentrackioEncoding>(encoding),
                              static_cast<std::uint16_t>(number_at(&datagram[sequence_at], 2)),
                              offset, (length & last_flag) != 0, segment},
            {}};
}

std::optional<OpentrackioAssembler::Sample> OpentrackioAssembler::add(
    const std::string& sender, const OpentrackioPacket& packet, std::string& fault) {
    const std::vector<std::byte> segment(packet.segment.begin(), packet.segment.end());
    if (packet.offset == 0 && packet.is_last) {
        incomplete_.erase(sender);
        return Sample{packet.encoding, segment};
    }
    if (!incomplete_.contains(sender) && incomplete_.size() >= most_senders)
        incomplete_.erase(incomplete_.begin());
    Incomplete& sample = incomplete_[sender];
    const bool is_other = packet.sequence != sample.sequence || packet.encoding != sample.encoding;
    if (is_other && !sample.segments.empty()) {
        fault = fmt::format("an OpenTrackIO sample of which {} bytes came, and the rest did not",
                            sample.bytes);
        sample = {};
    }
    sample.sequence = packet.sequence;
    sample.encoding = packet.encoding;
    if (packet.is_last) sample.size = packet.offset + segment.size();
    if (sample.segments.emplace(packet.offset, segment).second) sample.bytes += segment.size();
    if (!sample.size || sample.bytes < *sample.size) return std::nullopt;
    Sample whole{sample.encoding, {}};
    for (const auto& [offset, bytes] : sample.segments) {
        if (offset != whole.bytes.size()) break;
        whole.bytes.insert(whole.bytes.end(), bytes.begin(), bytes.end());
    }
    const bool fits = whole.bytes.size() == *sample.size && whole.bytes.size() == sample.bytes;
    incomplete_.erase(sender);
    if (fits) return whole;
    fault = "an OpenTrackIO sample whose segments do not fit together";
    return std::nullopt;
}

OpentrackioCameraReading read_opentrackio_sample(std::span<const std::byte> bytes,
                                                 OpentrackioEncoding encoding) {
    const std::optional<Json> json = parsed(bytes, encoding);
    if (!json)
        return {{},
                fmt::format("an OpenTrackIO sample that is no object of {}",
                            encoding == OpentrackioEncoding::cbor ? "CBOR" : "JSON")};
    OpentrackioCamera camera;
    if (const auto source = json->find("sourceNumber");
        source != json->end() && source->is_number_unsigned())
        camera.source = source->get<std::uint32_t>();
    const auto transforms = json->find("transforms");
    if (transforms == json->end() || !transforms->is_array() || transforms->empty())
        return {{}, "an OpenTrackIO sample without transforms, which give the camera's place"};
    const std::optional<Pose> pose = composed(*transforms);
    if (!pose)
        return {{},
                "an OpenTrackIO sample with a transform that is no list of numbers, or beyond "
                "1000 km"};
    camera.world_from_camera.linear() = changed_axes() * pose->linear() * changed_axes();
    camera.world_from_camera.translation() = changed_axes() * pose->translation();
    const Json& lens = part(*json, "lens");
    camera.focal_length_mm = positive(lens, "pinholeFocalLength");
    camera.focus_m = positive(lens, "focusDistance");
    camera.sensor_width_mm = positive(
        part(part(part(*json, "static"), "camera"), "activeSensorPhysicalDimensions"), "width");
    return {camera, {}};
}

std::vector<std::byte> write_opentrackio_sample(const OpentrackioSample& sample,
                                                OpentrackioEncoding encoding) {
    const CameraState& camera = sample.camera;
    const PanTiltRoll turn = pan_tilt_roll_of(camera.world_from_camera);
    const Eigen::Vector3d at = changed_axes().transpose() * camera.world_from_camera.translation();
    const double aspect = sample.height_px > 0 ? static_cast<double>(sample.width_px) /
                                                     static_cast<double>(sample.height_px)
                                               : 1;
    const Json json{
        {"static",
         {{"camera",
           {{"activeSensorPhysicalDimensions",
             {{"width", sample.sensor_width_mm}, {"height", sample.sensor_width_mm / aspect}}},
            {"activeSensorResolution", {{"width", sample.width_px}, {"height", sample.height_px}}},
            {"captureFrameRate", fraction(sample.rate)},
            {"make", "Vantage"},
            {"model", "virtual camera"}}},
          {"tracker", {{"make", "Vantage"}, {"model", "flight controller"}}}}},
        {"tracker", {{"recording", false}, {"status", "tracking"}}},
        {"timing", timing(sample)},
        {"lens",
         {{"pinholeFocalLength",
           sample.sensor_width_mm / 2 / std::tan(camera.field_of_view_rad / 2)},
          {"focusDistance", camera.focus_m},
          {"projectionOffset", {{"x", 0.0}, {"y", 0.0}}},
          {"entrancePupilOffset", 0.0}}},
        {"protocol", {{"name", "OpenTrackIO"}, {"version", {1, 0, 1}}}},
        {"sampleId", sample.sample_id},
        {"sourceId", sample.source_id},
        {"sourceNumber", sample.source},
        {"transforms", Json::array({{{"id", "Camera"},
                                     {"translation", {{"x", at.x()}, {"y", at.y()}, {"z", at.z()}}},
                                     {"rotation",
                                      {{"pan", -turn.pan_rad / degree},
                                       {"tilt", turn.tilt_rad / degree},
                                       {"roll", turn.roll_rad / degree}}}}})}};
    if (encoding == OpentrackioEncoding::json) {
        const std::string text = json.dump();
        const std::span bytes = std::as_bytes(std::span(text));
        return {bytes.begin(), bytes.end()};
    }
    const std::vector<std::uint8_t> cbor = Json::to_cbor(json);
    const std::span bytes = std::as_bytes(std::span(cbor));
    return {bytes.begin(), bytes.end()};
}

std::string uuid_urn(std::uint64_t base, std::uint64_t number) {
    constexpr std::uint64_t version = 0x8000, variant = 0x8000;
    return fmt::format("urn:uuid:{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", base >> 32,
                       base >> 16 & 0xffff, version | (base >> 4 & 0x0fff),
                       variant | (base & 0x0fff), number & 0xffff'ffff'ffff);
}

}  // namespace vantage
