#include "common/wire/frame_codec.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/base/error.h"
#include "common/wire/codec/colour_codec.h"
#include "common/wire/codec/disparity_codec.h"
#include "common/wire/codec/right_picture.h"
#include "common/wire/header_fields.h"
#include "common/wire/limits.h"
#include "frame.pb.h"

namespace vantage {
namespace {

/// The tolerance for unit length and right angles of a rotation, since poses pass through text
/// files.
constexpr double rotation_tolerance = 1e-4;
/// A pose further away is taken for a mistake in units.
constexpr double max_distance_m = 1e5;
constexpr double max_focal_length_px = 1e6;

void check_size(std::string_view what, std::uint32_t width, std::uint32_t height) {
    if (width < 1 || height < 1 || width > max_picture_side_px || height > max_picture_side_px)
        fail("a {} size of {}x{} is outside 1x1..{}x{}", what, width, height, max_picture_side_px,
             max_picture_side_px);
}

void check_range(std::string_view what, double value, double lowest, double highest) {
    if (!std::isfinite(value) || value < lowest || value > highest)
        fail("{} = {} is outside {}..{}", what, value, lowest, highest);
}

void check_geometry(const wire::Geometry& geometry) {
    check_range("geometry.f_px", geometry.f_px(), 1e-3, max_focal_length_px);
    check_range("geometry.cx_left_px", geometry.cx_left_px(), -max_focal_length_px,
                max_focal_length_px);
    check_range("geometry.cx_right_px", geometry.cx_right_px(), -max_focal_length_px,
                max_focal_length_px);
    check_range("geometry.cy_px", geometry.cy_px(), -max_focal_length_px, max_focal_length_px);
    check_range("geometry.baseline_m", geometry.baseline_m(), 1e-6, max_distance_m);
    constexpr int pose_numbers = 12;
    if (geometry.world_from_camera_size() != pose_numbers)
        fail("geometry.world_from_camera has {} numbers instead of {}",
             geometry.world_from_camera_size(), pose_numbers);
    for (const double value : geometry.world_from_camera())
        check_range("geometry.world_from_camera", value, -max_distance_m, max_distance_m);
}

Pose to_pose(const wire::Geometry& geometry) {
    Pose pose = Pose::Identity();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            pose.matrix()(row, column) = geometry.world_from_camera(4 * row + column);
    const Eigen::Matrix3d rotation = pose.linear();
    const double error =
        (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (error > rotation_tolerance || rotation.determinant() < 0)
        fail(
            "geometry.world_from_camera is not a rotation and a translation: its rows are off by "
            "{}",
            error);
    return pose;
}

constexpr double an_hour_ms = 3.6e6;

/// A duration that was measured on this computer: whatever a clock did to it, the frame can travel.
float sendable_ms(float ms) {
    return std::isfinite(ms) ? std::clamp(ms, 0.0F, static_cast<float>(an_hour_ms)) : 0.0F;
}

void check_times(const wire::StageTimes& times) {
    check_range("times.capture_ms", times.capture_ms(), 0, an_hour_ms);
    check_range("times.rectify_ms", times.rectify_ms(), 0, an_hour_ms);
    check_range("times.match_ms", times.match_ms(), 0, an_hour_ms);
    check_range("times.pack_ms", times.pack_ms(), 0, an_hour_ms);
}

/// Validates a header without its payloads. Encoder and decoder both use it.
Pose check_header(const wire::FrameHeader& header) {
    check_schema_version("frame", header.schema_version());
    // The last fields of a header are always written, so that a truncation between two fields is
    // noticed.
    if (!header.has_times() || !header.has_counters() || !header.has_sync())
        fail("a frame header is truncated");
    check_name("rig", header.rig());
    if (!header.calibration_id().empty()) check_name("calibration id", header.calibration_id());
    if (header.trigger_index() > max_trigger_index)
        fail("trigger index {} is beyond {}", header.trigger_index(), max_trigger_index);
    if (header.exposure_tai_ns() < 0 || header.published_tai_ns() < 0)
        fail("a frame's times have to lie after 1970: exposed at {} ns, published at {} ns",
             header.exposure_tai_ns(), header.published_tai_ns());
    check_range("max_disparity_px", header.max_disparity_px(), 0, max_disparity_px);
    check_times(header.times());
    const wire::Geometry& geometry = header.geometry();
    check_size("picture", geometry.width_px(), geometry.height_px());
    if (header.content() == wire::FrameHeader::RAW_PAIR) {
        if (geometry.f_px() != 0 || geometry.baseline_m() != 0 ||
            geometry.world_from_camera_size() != 0 ||
            header.disparity_codec() != wire::FrameHeader::DISPARITY_NONE ||
            header.colour_codec() == wire::FrameHeader::COLOUR_NONE ||
            header.right_jpeg_bytes() > 0)
            fail("a raw pair carries two pictures and neither geometry nor disparity");
        return Pose::Identity();
    }
    if (header.content() != wire::FrameHeader::VIEW)
        fail("a frame has the unknown content {}", static_cast<int>(header.content()));
    check_geometry(geometry);
    if (header.disparity_codec() != wire::FrameHeader::DISPARITY_NONE) {
        check_size("disparity", header.disparity_width_px(), header.disparity_height_px());
        if (header.disparity_width_px() > header.geometry().width_px() ||
            header.disparity_height_px() > header.geometry().height_px())
            fail("a disparity image of {}x{} does not fit a colour image of {}x{}",
                 header.disparity_width_px(), header.disparity_height_px(),
                 header.geometry().width_px(), header.geometry().height_px());
    } else if (header.colour_codec() == wire::FrameHeader::COLOUR_NONE) {
        fail("a frame has neither colour nor disparity");
    }
    if (header.right_jpeg_bytes() > 0 && header.colour_codec() != wire::FrameHeader::COLOUR_JPEG)
        fail("a frame whose colour is no JPEG has a right picture of {} bytes behind it",
             header.right_jpeg_bytes());
    return to_pose(header.geometry());
}

/// Refuses a payload longer than its image could be, and an empty one where an image is expected.
void check_payload(std::string_view what, bool expected, std::size_t bytes, std::size_t raw_bytes) {
    if (!expected && bytes > 0)
        fail("a frame without {} carries a {} payload of {} bytes", what, what, bytes);
    if (expected && bytes == 0) fail("the {} payload is empty", what);
    if (expected && bytes > raw_bytes + payload_slack_bytes)
        fail("the {} payload of {} bytes is beyond the limit of {} for its size", what, bytes,
             raw_bytes + payload_slack_bytes);
}

int checked_quality(int jpeg_quality) {
    if (jpeg_quality < 0 || jpeg_quality > 100)
        fail("jpeg_quality = {} is outside 0..100; 0 is lossless colour", jpeg_quality);
    return jpeg_quality;
}

}  // namespace

struct ColourPacker::Impl {
    int jpeg_quality;
    Chroma chroma;
    JpegEncoder jpeg;
    LosslessColourEncoder lossless;
};

ColourPacker::ColourPacker(int jpeg_quality, Chroma chroma) : impl_(std::make_unique<Impl>()) {
    impl_->jpeg_quality = checked_quality(jpeg_quality);
    impl_->chroma = chroma;
}

ColourPacker::~ColourPacker() = default;

void ColourPacker::pack(RigFrame& frame) {
    const MonotonicTime start = MonotonicClock::now();
    frame.packed_right_bytes = 0;
    if (impl_->jpeg_quality == 0) {
        frame.packed_colour = impl_->lossless.encode(frame.colour);
    } else {
        frame.packed_colour = impl_->jpeg.encode(frame.colour, impl_->jpeg_quality, impl_->chroma);
        if (!frame.right.empty()) {
            const std::vector<std::byte> right = pack_right_picture(impl_->jpeg, frame.right);
            frame.packed_colour.insert(frame.packed_colour.end(), right.begin(), right.end());
            frame.packed_right_bytes = right.size();
        }
    }
    frame.times.pack_ms = static_cast<float>(ms_since(start));
}

struct FrameEncoder::Impl {
    Impl(int quality, Chroma chroma) : jpeg_quality(quality), packer(quality, chroma) {}

    int jpeg_quality;
    ColourPacker packer;                    ///< for views
    LosslessColourEncoder lossless_colour;  ///< for raw pairs
    DisparityEncoder disparity;
};

FrameEncoder::FrameEncoder(int jpeg_quality, Chroma chroma)
    : impl_(std::make_unique<Impl>(jpeg_quality, chroma)) {}

FrameEncoder::~FrameEncoder() = default;

PackedFrame FrameEncoder::encode(RigFrame& frame) {
    const MonotonicTime start = MonotonicClock::now();
    const bool is_raw_pair = frame.content == RigFrame::Content::raw_pair;
    // Calibration measures corners to 0.01 px, so raw pairs are lossless.
    const bool lossless = impl_->jpeg_quality == 0 || is_raw_pair;
    wire::FrameHeader header;
    header.set_schema_version(wire_schema_version);
    header.set_rig(frame.rig);
    header.set_session(frame.session);
    header.set_synchronized(frame.synchronized);
    header.set_trigger_index(frame.trigger_index);
    header.set_exposure_tai_ns(to_ns(frame.exposure));
    header.set_calibration_id(frame.calibration_id);
    wire::Geometry& geometry = *header.mutable_geometry();
    geometry.set_width_px(static_cast<std::uint32_t>(frame.geometry.width_px));
    geometry.set_height_px(static_cast<std::uint32_t>(frame.geometry.height_px));
    if (is_raw_pair) {
        header.set_content(wire::FrameHeader::RAW_PAIR);
    } else {
        geometry.set_f_px(frame.geometry.f_px);
        geometry.set_cx_left_px(frame.geometry.cx_left_px);
        geometry.set_cx_right_px(frame.geometry.cx_right_px);
        geometry.set_cy_px(frame.geometry.cy_px);
        geometry.set_baseline_m(frame.geometry.baseline_m);
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
                geometry.add_world_from_camera(frame.world_from_camera.matrix()(row, column));
        geometry.set_place_is_assumed(frame.place_is_assumed);
        header.set_max_disparity_px(frame.max_disparity_px);
    }
    header.mutable_times()->set_capture_ms(sendable_ms(frame.times.capture_ms));
    header.mutable_times()->set_rectify_ms(sendable_ms(frame.times.rectify_ms));
    header.mutable_times()->set_match_ms(sendable_ms(frame.times.match_ms));
    to_wire(frame.counters, *header.mutable_counters());
    to_wire(frame.sync, *header.mutable_sync());
    if (!frame.colour.empty())
        header.set_colour_codec(lossless ? wire::FrameHeader::COLOUR_ZSTD_RGBA
                                         : wire::FrameHeader::COLOUR_JPEG);
    if (!frame.disparity.empty()) {
        header.set_disparity_codec(wire::FrameHeader::DISPARITY_ZSTD_U16);
        header.set_disparity_width_px(static_cast<std::uint32_t>(frame.disparity.cols));
        header.set_disparity_height_px(static_cast<std::uint32_t>(frame.disparity.rows));
    }
    check_header(header);
    if (!frame.colour.empty() && (frame.colour.cols != frame.geometry.width_px ||
                                  frame.colour.rows != frame.geometry.height_px))
        fail("a colour picture of {}x{} does not fit its geometry of {}x{}", frame.colour.cols,
             frame.colour.rows, frame.geometry.width_px, frame.geometry.height_px);
    if ((is_raw_pair || !frame.right.empty()) && frame.right.size() != frame.colour.size())
        fail("a pair of {}x{} and {}x{} has to be of one size", frame.colour.cols,
             frame.colour.rows, frame.right.cols, frame.right.rows);

    PackedFrame packed;
    packed.trigger_index = frame.trigger_index;
    packed.is_raw_pair = is_raw_pair;
    const bool is_packed_ahead = !frame.packed_colour.empty();
    if (is_raw_pair) {
        packed.colour = impl_->lossless_colour.encode(frame.colour);
        packed.disparity = impl_->lossless_colour.encode(frame.right);
    } else {
        if (!is_packed_ahead && !frame.colour.empty()) impl_->packer.pack(frame);
        packed.colour = std::move(frame.packed_colour);
        header.set_right_jpeg_bytes(static_cast<std::uint32_t>(frame.packed_right_bytes));
    }
    if (!frame.disparity.empty()) packed.disparity = impl_->disparity.encode(frame.disparity);

    frame.times.pack_ms =
        static_cast<float>(ms_since(start)) + (is_packed_ahead ? frame.times.pack_ms : 0.0f);
    frame.published = TaiClock::now();
    header.mutable_times()->set_pack_ms(sendable_ms(frame.times.pack_ms));
    header.set_published_tai_ns(to_ns(frame.published));
    packed.header = serialise(header);
    return packed;
}

FrameHead decode_frame_head(std::span<const std::byte> part) {
    wire::FrameHeader header;
    parse(part, "frame header", header);
    FrameHead head;
    RigFrame& frame = head.frame;
    frame.world_from_camera = check_header(header);
    frame.place_is_assumed = header.geometry().place_is_assumed();
    const bool is_raw_pair = header.content() == wire::FrameHeader::RAW_PAIR;
    if (is_raw_pair) frame.content = RigFrame::Content::raw_pair;
    frame.rig = header.rig();
    frame.session = header.session();
    frame.synchronized = header.synchronized();
    frame.trigger_index = header.trigger_index();
    frame.exposure = tai_from_ns(header.exposure_tai_ns());
    frame.published = tai_from_ns(header.published_tai_ns());
    frame.calibration_id = header.calibration_id();
    frame.geometry.width_px = static_cast<int>(header.geometry().width_px());
    frame.geometry.height_px = static_cast<int>(header.geometry().height_px());
    if (!is_raw_pair) {
        frame.geometry.f_px = header.geometry().f_px();
        frame.geometry.cx_left_px = header.geometry().cx_left_px();
        frame.geometry.cx_right_px = header.geometry().cx_right_px();
        frame.geometry.cy_px = header.geometry().cy_px();
        frame.geometry.baseline_m = header.geometry().baseline_m();
    }
    frame.max_disparity_px = header.max_disparity_px();
    head.right_jpeg_bytes = header.right_jpeg_bytes();
    frame.times = {header.times().capture_ms(), header.times().rectify_ms(),
                   header.times().match_ms(), header.times().pack_ms()};
    frame.counters = from_wire(header.counters());
    frame.sync = from_wire(header.sync());
    switch (header.colour_codec()) {
        case wire::FrameHeader::COLOUR_NONE:
            break;
        case wire::FrameHeader::COLOUR_JPEG:
            head.colour = FrameHead::Colour::jpeg;
            break;
        case wire::FrameHeader::COLOUR_ZSTD_RGBA:
            head.colour = FrameHead::Colour::lossless;
            break;
        default:
            fail("the colour codec {} is unknown", static_cast<int>(header.colour_codec()));
    }
    switch (header.disparity_codec()) {
        case wire::FrameHeader::DISPARITY_NONE:
            break;
        case wire::FrameHeader::DISPARITY_ZSTD_U16:
            head.disparity_px = {static_cast<int>(header.disparity_width_px()),
                                 static_cast<int>(header.disparity_height_px())};
            break;
        default:
            fail("disparity codec {} is not known here",
                 static_cast<int>(header.disparity_codec()));
    }
    return head;
}

struct FrameDecoder::Impl {
    JpegDecoder jpeg;
    LosslessColourDecoder lossless_colour;
    DisparityDecoder disparity;
};

ColourParts colour_parts(const FrameHead& head, std::span<const std::byte> colour) {
    if (head.right_jpeg_bytes > colour.size())
        fail("a right picture of {} bytes does not fit a colour payload of {}",
             head.right_jpeg_bytes, colour.size());
    return {colour.first(colour.size() - head.right_jpeg_bytes),
            colour.last(head.right_jpeg_bytes)};
}

SharedBytes shared(std::span<const std::byte> bytes) {
    return bytes.empty()
               ? nullptr
               : std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
}

FrameDecoder::FrameDecoder() : impl_(std::make_unique<Impl>()) {}

FrameDecoder::~FrameDecoder() = default;

RigFrame FrameDecoder::decode(std::span<const std::byte> header, std::span<const std::byte> colour,
                              std::span<const std::byte> disparity) {
    FrameHead head = decode_frame_head(header);
    RigFrame& frame = head.frame;
    const int width = frame.geometry.width_px, height = frame.geometry.height_px;
    const auto bytes = [](int w, int h, std::size_t each) {
        return static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * each;
    };
    const ColourParts parts = colour_parts(head, colour);
    check_payload("colour", head.colour != FrameHead::Colour::none, parts.left.size(),
                  bytes(width, height, sizeof(cv::Vec4b)));
    check_payload("right picture", head.right_jpeg_bytes > 0, parts.right.size(),
                  bytes(width, height, sizeof(cv::Vec4b)));
    const bool is_raw_pair = frame.content == RigFrame::Content::raw_pair;
    const bool has_disparity = !head.disparity_px.empty();
    if (is_raw_pair)
        check_payload("right picture", true, disparity.size(),
                      bytes(width, height, sizeof(cv::Vec4b)));
    else
        check_payload(
            "disparity", has_disparity, disparity.size(),
            bytes(head.disparity_px.width, head.disparity_px.height, sizeof(std::uint16_t)));

    switch (head.colour) {
        case FrameHead::Colour::none:
            break;
        case FrameHead::Colour::jpeg:
            frame.colour = impl_->jpeg.decode(parts.left, width, height);
            frame.right_jpeg = shared(parts.right);
            if (is_raw_pair) frame.right = impl_->jpeg.decode(disparity, width, height);
            break;
        case FrameHead::Colour::lossless:
            frame.colour = impl_->lossless_colour.decode(colour, width, height);
            if (is_raw_pair) frame.right = impl_->lossless_colour.decode(disparity, width, height);
            break;
    }
    if (has_disparity)
        frame.disparity =
            impl_->disparity.decode(disparity, head.disparity_px.width, head.disparity_px.height);
    return std::move(frame);
}

}  // namespace vantage
