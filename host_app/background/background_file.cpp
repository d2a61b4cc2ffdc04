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

/// Files of all versions begin with this.
constexpr std::string_view first_line = "vantage learnt set\n";  // old name
constexpr std::uint32_t version = 1;
constexpr int max_rigs = 64;
/// Limits the memory for all rigs' pictures: ninety of 960x720.
constexpr std::int64_t max_pixels = std::int64_t{1} << 26;
/// Size of a file whose pictures do not compress at all.
constexpr std::size_t max_bytes = max_pixels * (sizeof(cv::Vec4b) + sizeof(float) + 1);
/// A larger depth is no measurement.
constexpr float max_depth_m = 1e6f;

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
        if (!(z >= 0 && z <= max_depth_m))
            fail("a depth of {} m of rig {} is outside 0..{:g}", z, rig.rig, max_depth_m);
    rig.colour = LosslessColourDecoder().decode(bytes_in(from.colour()), width_px, height_px);
    return rig;
}

}  // namespace

std::vector<std::byte> encode_background(const Background& background) {
    learnt::Background message;
    message.set_version(version);
    message.set_learnt_tai_ns(to_ns(background.learnt));
    PayloadCompressor zstd;
    LosslessColourEncoder colours;
    for (const RigBackground& rig : background.rigs) {
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

Background decode_background(std::span<const std::byte> bytes) {
    if (bytes.size() < first_line.size() ||
        std::memcmp(bytes.data(), first_line.data(), first_line.size()) != 0)
        fail("it is not a background file: it does not begin with '{}'",
             first_line.substr(0, first_line.size() - 1));
    const std::span<const std::byte> rest = bytes.subspan(first_line.size());
    keep_protobuf_quiet();
    learnt::Background message;
    if (rest.size() > max_bytes ||
        !message.ParseFromArray(rest.data(), static_cast<int>(rest.size())))
        fail("the background file is damaged");
    if (message.version() != version)
        fail(
            "it is a background file of version {}, this program reads version {}: learn the "
            "background again",
            message.version(), version);
    if (message.rigs_size() < 1 || message.rigs_size() > max_rigs)
        fail("it has the background of {} rigs, which is outside 1..{}", message.rigs_size(),
             max_rigs);
    Background background;
    if (message.learnt_tai_ns() < 0) fail("its time is before 1970");
    background.learnt = tai_from_ns(message.learnt_tai_ns());
    std::int64_t pixels = 0;
    for (const learnt::RigBackground& rig : message.rigs()) {
        pixels += std::max(
            std::int64_t{side("picture", rig.width_px())} * side("picture", rig.height_px()),
            std::int64_t{side("depth map", rig.depth_width_px())} *
                side("depth map", rig.depth_height_px()));
        if (pixels > max_pixels)
            fail("its pictures have more than the {} pixels that a background file may have",
                 max_pixels);
    }
    for (const learnt::RigBackground& rig : message.rigs())
        background.rigs.push_back(decode_rig(rig));
    return background;
}

Background load_background(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = read_file(path, max_bytes);
    try {
        return decode_background(bytes);
    } catch (const Error& error) {
        fail("could not load {}: {}", path.string(), error.what());
    }
}

void save_background(const Background& background, const std::filesystem::path& path) {
    write_file_atomically(path, encode_background(background));
}

}  // namespace vantage
