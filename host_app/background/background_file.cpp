#include "host_app/background/background_file.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "background.pb.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/wire/codec/colour_codec.h"
#include "common/wire/codec/payload_compression.h"
#include "common/wire/header_fields.h"
#include "common/wire/limits.h"

namespace vantage {
namespace {

constexpr std::string_view first_line = "vantage learnt set\n";
constexpr std::uint32_t version = 1;
constexpr int most_rigs = 64;
/// Of all rigs' pictures: ninety of 960x720.
constexpr std::int64_t most_pixels = std::int64_t{1} << 26;
/// What those are where nothing compresses.
constexpr std::size_t most_bytes = most_pixels * (sizeof(cv::Vec4b) + sizeof(float) + 1);
constexpr float farthest_m = 1e6f;

template <class Picture>
std::span<const std::byte> bytes_of(const Picture& picture) {
    return std::as_bytes(
        std::span(picture.template ptr<std::uint8_t>(), picture.total() * picture.elemSize()));
}

std::string text_of(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> bytes_in(const std::string& text) {
    return std::as_bytes(std::span(text));
}

int side(std::string_view what, std::uint32_t px) {
    if (px < 1 || px > static_cast<std::uint32_t>(max_picture_side_px))
        fail("a {} of {} pixels a side is outside 1..{}", what, px, max_picture_side_px);
    return static_cast<int>(px);
}

template <class Picture>
Picture unpacked(PayloadDecompressor& zstd, const std::string& payload, cv::Size size,
                 std::string_view what) {
    const std::span<const std::byte> raw = zstd.decompress(
        bytes_in(payload),
        static_cast<std::size_t>(size.area()) * sizeof(typename Picture::value_type), what);
    Picture picture(size);
    std::memcpy(picture.data, raw.data(), raw.size());
    return picture;
}

RigBackground decode_rig(const learnt::RigBackground& from) {
    RigBackground rig;
    check_name("rig", from.rig());
    check_name("calibration", from.calibration().substr(from.calibration().find(':') + 1));
    rig.rig = from.rig();
    rig.calibration = from.calibration();
    const int width_px = side("picture", from.width_px());
    const int height_px = side("picture", from.height_px());
    const cv::Size depth_size(side("depth map", from.depth_width_px()),
                              side("depth map", from.depth_height_px()));
    PayloadDecompressor zstd;
    rig.certainty = unpacked<cv::Mat1b>(zstd, from.certainty(), depth_size, "certainty");
    rig.depth_m = unpacked<DepthImage>(zstd, from.depth(), depth_size, "depth");
    for (const float z : rig.depth_m)
        if (!(z >= 0 && z <= farthest_m))
            fail("a depth of {} m of rig {} is outside 0..{:g}", z, rig.rig, farthest_m);
    rig.colour = LosslessColourDecoder().decode(bytes_in(from.colour()), width_px, height_px);
    return rig;
}

}  // namespace

std::vector<std::byte> encode_frame_set(const Background& set) {
    learnt::Background message;
    message.set_version(version);
    message.set_learnt_tai_ns(to_ns(set.learnt));
    PayloadCompressor zstd;
    LosslessColourEncoder colours;
    for (const RigBackground& rig : set.rigs) {
        learnt::RigBackground& to = *message.add_rigs();
        to.set_rig(rig.rig);
        to.set_calibration(rig.calibration);
        to.set_width_px(static_cast<std::uint32_t>(rig.colour.cols));
        to.set_height_px(static_cast<std::uint32_t>(rig.colour.rows));
        to.set_depth_width_px(static_cast<std::uint32_t>(rig.depth_m.cols));
        to.set_depth_height_px(static_cast<std::uint32_t>(rig.depth_m.rows));
        to.set_colour(text_of(colours.encode(rig.colour)));
        to.set_depth(text_of(zstd.compress(bytes_of(rig.depth_m))));
        to.set_certainty(text_of(zstd.compress(bytes_of(rig.certainty))));
    }
    const std::string text = std::string(first_line) + message.SerializeAsString();
    const std::span<const std::byte> bytes = bytes_in(text);
    return {bytes.begin(), bytes.end()};
}

Background decode_frame_set(std::span<const std::byte> bytes) {
    if (bytes.size() < first_line.size() ||
        std::memcmp(bytes.data(), first_line.data(), first_line.size()) != 0)
        fail("it is no learnt set: it does not begin with '{}'",
             first_line.substr(0, first_line.size() - 1));
    const std::span<const std::byte> rest = bytes.subspan(first_line.size());
    keep_protobuf_quiet();
    learnt::Background message;
    if (rest.size() > most_bytes ||
        !message.ParseFromArray(rest.data(), static_cast<int>(rest.size())))
        fail("it is a damaged learnt set");
    if (message.version() != version)
        fail("it is a learnt set of version {}; this program knows version {}: learn it anew",
             message.version(), version);
    if (message.rigs_size() < 1 || message.rigs_size() > most_rigs)
        fail("it is the set of {} rigs, which is outside 1..{}", message.rigs_size(), most_rigs);
    Background set;
    if (message.learnt_tai_ns() < 0) fail("it was learnt before 1970");
    set.learnt = tai_from_ns(message.learnt_tai_ns());
    std::int64_t pixels = 0;
    for (const learnt::RigBackground& rig : message.rigs()) {
        pixels += std::max(
            std::int64_t{side("picture", rig.width_px())} * side("picture", rig.height_px()),
            std::int64_t{side("depth map", rig.depth_width_px())} *
                side("depth map", rig.depth_height_px()));
        if (pixels > most_pixels)
            fail("its pictures have more than the {} pixels that a set may have", most_pixels);
    }
    for (const learnt::RigBackground& rig : message.rigs()) set.rigs.push_back(decode_rig(rig));
    return set;
}

Background load_set(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = read_file(path, most_bytes);
    try {
        return decode_frame_set(bytes);
    } catch (const Error& error) {
        fail("{} cannot be used: {}", path.string(), error.what());
    }
}

void save_background(const Background& set, const std::filesystem::path& path) {
    write_file_atomically(path, encode_frame_set(set));
}

}  // namespace vantage
