#include "common/wire/frame_codec.h"

#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/wire/codec/right_picture.h"
#include "common/wire/limits.h"
#include "frame.pb.h"
#include "tests/support/thrown_sentence.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using testing::HasSubstr;

constexpr int lossless = 0;

RigFrame decode(const PackedFrame& packed) {
    return FrameDecoder().decode(packed.header, packed.colour, packed.disparity);
}

std::string refusal_of(const PackedFrame& packed) {
    return thrown_sentence([&] { decode(packed); });
}

void expect_same_numbers(const RigFrame& got, const RigFrame& sent) {
    EXPECT_EQ(got.rig, sent.rig);
    EXPECT_EQ(got.session, sent.session);
    EXPECT_EQ(got.synchronized, sent.synchronized);
    EXPECT_EQ(got.trigger_index, sent.trigger_index);
    EXPECT_EQ(got.exposure, sent.exposure);
    EXPECT_EQ(got.published, sent.published);
    EXPECT_EQ(got.calibration_id, sent.calibration_id);
    EXPECT_EQ(got.geometry.width_px, sent.geometry.width_px);
    EXPECT_EQ(got.geometry.height_px, sent.geometry.height_px);
    EXPECT_EQ(got.geometry.f_px, sent.geometry.f_px);
    EXPECT_EQ(got.geometry.cx_left_px, sent.geometry.cx_left_px);
    EXPECT_EQ(got.geometry.cx_right_px, sent.geometry.cx_right_px);
    EXPECT_EQ(got.geometry.cy_px, sent.geometry.cy_px);
    EXPECT_EQ(got.geometry.baseline_m, sent.geometry.baseline_m);
    EXPECT_EQ(got.world_from_camera.matrix(), sent.world_from_camera.matrix());
    EXPECT_EQ(got.place_is_assumed, sent.place_is_assumed);
    EXPECT_EQ(got.max_disparity_px, sent.max_disparity_px);
    EXPECT_EQ(got.times.capture_ms, sent.times.capture_ms);
    EXPECT_EQ(got.times.rectify_ms, sent.times.rectify_ms);
    EXPECT_EQ(got.times.match_ms, sent.times.match_ms);
    EXPECT_EQ(got.times.pack_ms, sent.times.pack_ms);
    EXPECT_EQ(got.counters.captured, sent.counters.captured);
    EXPECT_EQ(got.counters.missed, sent.counters.missed);
    EXPECT_EQ(got.counters.late, sent.counters.late);
    EXPECT_EQ(got.sync, sent.sync);
}

TEST(FrameCodec, RoundTripsALosslessFrame) {
    RigFrame sent = make_frame(max_trigger_index, 311, 239);
    FrameEncoder encoder(lossless);
    const RigFrame got = decode(encoder.encode(sent));
    expect_same_numbers(got, sent);
    EXPECT_TRUE(same_pixels(got.colour, sent.colour));
    EXPECT_TRUE(same_pixels(got.disparity, sent.disparity));
}

TEST(FrameCodec, JpegColourLeavesTheRestExact) {
    RigFrame sent = make_frame(3);
    FrameEncoder encoder(85);
    const RigFrame got = decode(encoder.encode(sent));
    expect_same_numbers(got, sent);
    EXPECT_EQ(got.colour.size(), sent.colour.size());
    EXPECT_TRUE(same_pixels(got.disparity, sent.disparity));
}

TEST(FrameCodec, ColourPackedEarlyGivesTheSameFrame) {
    for (const int quality : {lossless, 85}) {
        RigFrame at_once = make_frame(3), ahead = make_frame(3);
        ColourPacker packer(quality);
        packer.pack(ahead);
        const float ahead_ms = ahead.times.pack_ms;
        EXPECT_GT(ahead_ms, 0);
        FrameEncoder encoder(quality);
        const PackedFrame packed_ahead = encoder.encode(ahead);
        EXPECT_EQ(packed_ahead.colour, encoder.encode(at_once).colour);
        EXPECT_GT(ahead.times.pack_ms, ahead_ms) << "the rest takes its time too";
        expect_same_numbers(decode(packed_ahead), ahead);
    }
}

TEST(FrameCodec, ARightImageFollowsTheLeftOnesJpeg) {
    for (const bool is_ahead : {false, true}) {
        RigFrame sent = make_frame(3);
        sent.right = make_frame(4).colour;
        const std::vector<std::byte> left = FrameEncoder(85).encode(sent).colour;
        RigFrame alone = make_frame(3);
        const std::size_t left_bytes = FrameEncoder(85).encode(alone).colour.size();
        if (is_ahead) ColourPacker(85).pack(sent);
        const PackedFrame packed = FrameEncoder(85).encode(sent);
        EXPECT_EQ(packed.colour, left);
        const RigFrame got = decode(packed);
        expect_same_numbers(got, sent);
        EXPECT_TRUE(same_pixels(got.colour, decode(FrameEncoder(85).encode(alone)).colour));
        ASSERT_TRUE(got.right_jpeg);
        EXPECT_EQ(got.right_jpeg->size(), packed.colour.size() - left_bytes);
        const ColourImage right = JpegDecoder().decode(*got.right_jpeg, 61, 47);
        EXPECT_LT(cv::norm(right, sent.right, cv::NORM_L1) / static_cast<double>(right.total()),
                  30);
        // Whoever knows nothing of it sees the left one.
        EXPECT_TRUE(same_pixels(JpegDecoder().decode(packed.colour, 61, 47), got.colour));
    }
}

TEST(FrameCodec, ALargeRightPictureTravelsSmaller) {
    EXPECT_EQ(background_match_size({640, 480}), cv::Size(640, 480));
    EXPECT_EQ(background_match_size({1456, 1088}), cv::Size(485, 362));
    EXPECT_EQ(background_match_size({641, 480}), cv::Size(320, 240));
    RigFrame sent = make_frame(3, 800, 600);
    sent.right = ColourImage(600, 800, cv::Vec4b(90, 120, 60, 255));
    const RigFrame got = decode(FrameEncoder(85).encode(sent));
    ASSERT_TRUE(got.right_jpeg);
    const ColourImage right = JpegDecoder().decode(*got.right_jpeg, 400, 300);
    EXPECT_LE(cv::norm(right, ColourImage(300, 400, cv::Vec4b(90, 120, 60, 255)), cv::NORM_INF), 2);
}

TEST(FrameCodec, LosslessColourTravelsWithoutARightPicture) {
    RigFrame sent = make_frame(3), ahead = make_frame(3), alone = make_frame(3);
    sent.right = ahead.right = make_frame(4).colour;
    ColourPacker(lossless).pack(ahead);
    const std::vector<std::byte> colour = FrameEncoder(lossless).encode(alone).colour;
    EXPECT_EQ(FrameEncoder(lossless).encode(sent).colour, colour);
    const PackedFrame packed = FrameEncoder(lossless).encode(ahead);
    EXPECT_EQ(packed.colour, colour);
    EXPECT_FALSE(decode(packed).right_jpeg);
}

TEST(FrameCodec, HostileRightPicturesAreRefused) {
    RigFrame sent = make_frame(3);
    sent.right = make_frame(4).colour;
    const PackedFrame whole = FrameEncoder(85).encode(sent);
    const auto refusal = [&](std::uint32_t right_bytes, wire::FrameHeader::ColourCodec codec) {
        PackedFrame packed = whole;
        wire::FrameHeader header;
        header.ParseFromArray(packed.header.data(), static_cast<int>(packed.header.size()));
        header.set_right_jpeg_bytes(right_bytes);
        header.set_colour_codec(codec);
        packed.header.resize(header.ByteSizeLong());
        header.SerializeToArray(packed.header.data(), static_cast<int>(packed.header.size()));
        return refusal_of(packed);
    };
    const auto all = static_cast<std::uint32_t>(whole.colour.size());
    EXPECT_THAT(refusal(all + 1, wire::FrameHeader::COLOUR_JPEG), HasSubstr("does not fit"));
    EXPECT_THAT(refusal(all, wire::FrameHeader::COLOUR_JPEG), HasSubstr("payload is empty"));
    EXPECT_THAT(refusal(all - 30, wire::FrameHeader::COLOUR_JPEG), HasSubstr("payload"));
    EXPECT_THAT(refusal(7, wire::FrameHeader::COLOUR_ZSTD_RGBA), HasSubstr("no JPEG"));
    RigFrame small = make_frame(3);
    small.right = ColourImage(5, 5);
    EXPECT_THAT(thrown_sentence([&] { FrameEncoder(85).encode(small); }), HasSubstr("one size"));
}

TEST(FrameCodec, DisparityMayBeSmallerThanColourAndEitherMayBeMissing) {
    FrameEncoder encoder(lossless);
    FrameDecoder decoder;
    const auto cross = [&](RigFrame sent) {
        const PackedFrame packed = encoder.encode(sent);
        const RigFrame got = decoder.decode(packed.header, packed.colour, packed.disparity);
        EXPECT_TRUE(same_pixels(got.colour, sent.colour));
        EXPECT_TRUE(same_pixels(got.disparity, sent.disparity));
    };
    RigFrame frame = make_frame(3);
    frame.disparity = DisparityImage(23, 30, std::uint16_t{7});
    cross(frame);
    frame.disparity = DisparityImage();
    cross(frame);
    frame = make_frame(3);
    frame.colour = ColourImage();
    cross(frame);
}

TEST(FrameCodec, OneDecoderTakesFramesOfChangingSizeAndSurvivesBadOnes) {
    FrameEncoder encoder(lossless);
    FrameDecoder decoder;
    for (const int width : {61, 311, 5, 97}) {
        RigFrame sent = make_frame(3, width, 47);
        const PackedFrame packed = encoder.encode(sent);
        EXPECT_THROW(decoder.decode(packed.header, packed.disparity, packed.colour), Error);
        const RigFrame got = decoder.decode(packed.header, packed.colour, packed.disparity);
        EXPECT_TRUE(same_pixels(got.disparity, sent.disparity));
    }
}

TEST(FrameCodec, RefusesToPackInvalidFrames) {
    FrameEncoder encoder(85);
    const auto refused = [&](const std::function<void(RigFrame&)>& spoil) {
        RigFrame frame = make_frame(3);
        spoil(frame);
        EXPECT_THROW(encoder.encode(frame), Error);
    };
    refused([](RigFrame& f) { f.rig = "no blanks"; });
    refused([](RigFrame& f) { f.geometry.f_px = std::numeric_limits<double>::quiet_NaN(); });
    refused([](RigFrame& f) { f.geometry.width_px = -1; });
    refused([](RigFrame& f) { f.geometry.width_px += 1; });
    refused([](RigFrame& f) { f.world_from_camera.linear() *= 2; });
    refused([](RigFrame& f) { f.disparity = DisparityImage(99, 99); });
    refused([](RigFrame& f) { f.colour = ColourImage(), f.disparity = DisparityImage(); });
    EXPECT_THROW(FrameEncoder(101), Error);
    EXPECT_THROW(FrameEncoder(-1), Error);
}

/// What both sensors saw, both pictures full of noise.
RigFrame make_raw_pair(std::uint64_t trigger_index) {
    RigFrame pair = make_frame(trigger_index);
    pair.content = RigFrame::Content::raw_pair;
    pair.right = make_frame(trigger_index + 1).colour;
    pair.disparity = DisparityImage();
    return pair;
}

TEST(FrameCodec, CarriesARawPairBitExactWhateverTheColourQuality) {
    for (const int quality : {lossless, 85}) {
        RigFrame sent = make_raw_pair(12);
        const PackedFrame packed = FrameEncoder(quality).encode(sent);
        EXPECT_TRUE(packed.is_raw_pair);
        const RigFrame got = decode(packed);
        EXPECT_EQ(got.content, RigFrame::Content::raw_pair);
        EXPECT_EQ(got.trigger_index, 12u);
        EXPECT_EQ(got.calibration_id, sent.calibration_id);
        EXPECT_EQ(got.geometry.width_px, sent.colour.cols);
        EXPECT_EQ(got.geometry.height_px, sent.colour.rows);
        EXPECT_TRUE(same_pixels(got.colour, sent.colour));
        EXPECT_TRUE(same_pixels(got.right, sent.right));
        EXPECT_TRUE(got.disparity.empty());
    }
}

TEST(FrameCodec, RefusesToPackAnInvalidRawPair) {
    RigFrame one_sided = make_raw_pair(3);
    one_sided.right = ColourImage();
    EXPECT_THAT(thrown_sentence([&] { FrameEncoder(lossless).encode(one_sided); }),
                HasSubstr("one size"));
    RigFrame with_disparity = make_raw_pair(3);
    with_disparity.disparity = make_frame(3).disparity;
    EXPECT_THAT(thrown_sentence([&] { FrameEncoder(lossless).encode(with_disparity); }),
                HasSubstr("neither geometry nor disparity"));
}

TEST(FrameCodec, HostileRawPairsAreRefused) {
    RigFrame sent = make_raw_pair(3);
    const PackedFrame whole = FrameEncoder(lossless).encode(sent);
    const auto refusal = [&](const std::function<void(wire::FrameHeader&)>& spoil) {
        PackedFrame packed = whole;
        wire::FrameHeader header;
        header.ParseFromArray(packed.header.data(), static_cast<int>(packed.header.size()));
        spoil(header);
        packed.header.resize(header.ByteSizeLong());
        header.SerializeToArray(packed.header.data(), static_cast<int>(packed.header.size()));
        return refusal_of(packed);
    };
    using Header = wire::FrameHeader;
    EXPECT_EQ(refusal([](Header&) {}), "");
    EXPECT_THAT(refusal([](Header& h) { h.mutable_geometry()->set_f_px(300); }),
                HasSubstr("neither geometry nor disparity"));
    EXPECT_THAT(refusal([](Header& h) { h.mutable_geometry()->add_world_from_camera(1); }),
                HasSubstr("neither geometry nor disparity"));
    EXPECT_THAT(refusal([](Header& h) { h.set_colour_codec(Header::COLOUR_NONE); }),
                HasSubstr("neither geometry nor disparity"));
    EXPECT_THAT(refusal([](Header& h) { h.set_content(static_cast<Header::Content>(7)); }),
                HasSubstr("content 7"));
    EXPECT_THAT(refusal([](Header& h) { h.set_content(Header::VIEW); }), HasSubstr("f_px"));
    EXPECT_THAT(refusal([](Header& h) { h.mutable_geometry()->set_width_px(4097); }),
                HasSubstr("4097x47"));
    EXPECT_THAT(refusal([](Header& h) { h.mutable_geometry()->set_height_px(48); }),
                HasSubstr("payload"));
    EXPECT_THAT(refusal([](Header& h) { h.set_colour_codec(Header::COLOUR_JPEG); }),
                HasSubstr("JPEG"));
    PackedFrame without_right = whole;
    without_right.disparity.clear();
    EXPECT_THAT(refusal_of(without_right), HasSubstr("right picture payload is empty"));
    PackedFrame overlong = whole;
    overlong.disparity.resize(61 * 47 * 4 + payload_slack_bytes + 1);
    EXPECT_THAT(refusal_of(overlong), HasSubstr("beyond the limit"));
    for (std::size_t size = 0; size < whole.header.size(); ++size) {
        PackedFrame cut = whole;
        cut.header.resize(size);
        EXPECT_THROW(decode(cut), Error) << size;
    }
}

/// A good frame whose header is then spoiled in one way.
struct Spoiled {
    const char* name;
    std::function<void(wire::FrameHeader&)> spoil;
    const char* expected;  ///< in the sentence
};

class HostileHeaderTest : public testing::TestWithParam<Spoiled> {};

TEST_P(HostileHeaderTest, IsRefusedWithASentenceThatNamesTheFault) {
    RigFrame frame = make_frame(3);
    PackedFrame packed = FrameEncoder(lossless).encode(frame);
    wire::FrameHeader header;
    ASSERT_TRUE(
        header.ParseFromArray(packed.header.data(), static_cast<int>(packed.header.size())));
    GetParam().spoil(header);
    packed.header.resize(header.ByteSizeLong());
    header.SerializeToArray(packed.header.data(), static_cast<int>(packed.header.size()));
    EXPECT_THAT(refusal_of(packed), HasSubstr(GetParam().expected));
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(
    Faults, HostileHeaderTest,
    testing::Values(
        Spoiled{"OtherVersion", [](auto& h) { h.set_schema_version(wire_schema_version + 1); },
                "schema version"},
        Spoiled{"NoVersion", [](auto& h) { h.clear_schema_version(); }, "schema version"},
        Spoiled{"NoRigName", [](auto& h) { h.clear_rig(); }, "rig name"},
        Spoiled{"LongRigName", [](auto& h) { h.set_rig(std::string(65, 'a')); }, "rig name"},
        Spoiled{"ControlCharacterInName", [](auto& h) { h.set_rig("rig\n"); }, "rig name"},
        Spoiled{"CalibrationId", [](auto& h) { h.set_calibration_id("a b"); }, "calibration id"},
        Spoiled{"TriggerIndex", [](auto& h) { h.set_trigger_index(max_trigger_index + 1); },
                "trigger index"},
        Spoiled{"NegativeExposure", [](auto& h) { h.set_exposure_tai_ns(-1); }, "times"},
        Spoiled{"NoGeometry", [](auto& h) { h.clear_geometry(); }, "picture size of 0x0"},
        Spoiled{"HugePicture", [](auto& h) { h.mutable_geometry()->set_width_px(4097); },
                "4097x47"},
        Spoiled{"HugerPicture", [](auto& h) { h.mutable_geometry()->set_height_px(0xffffffffu); },
                "61x4294967295"},
        Spoiled{"FocalLengthNaN", [](auto& h) { h.mutable_geometry()->set_f_px(nan); }, "f_px"},
        Spoiled{"FocalLengthZero", [](auto& h) { h.mutable_geometry()->set_f_px(0); }, "f_px"},
        Spoiled{"PrincipalPoint", [](auto& h) { h.mutable_geometry()->set_cx_left_px(infinity); },
                "cx_left_px"},
        Spoiled{"RightPrincipalPoint", [](auto& h) { h.mutable_geometry()->set_cx_right_px(nan); },
                "cx_right_px"},
        Spoiled{"PrincipalRow", [](auto& h) { h.mutable_geometry()->set_cy_px(-infinity); },
                "cy_px"},
        Spoiled{"BaselineNegative", [](auto& h) { h.mutable_geometry()->set_baseline_m(-0.1); },
                "baseline_m"},
        Spoiled{"PoseShort",
                [](auto& h) { h.mutable_geometry()->mutable_world_from_camera()->RemoveLast(); },
                "11 numbers"},
        Spoiled{"PoseLong", [](auto& h) { h.mutable_geometry()->add_world_from_camera(0); },
                "13 numbers"},
        Spoiled{"PoseNaN", [](auto& h) { h.mutable_geometry()->set_world_from_camera(5, nan); },
                "world_from_camera"},
        Spoiled{"PoseScaled",
                [](auto& h) {
                    for (int i = 0; i < 12; ++i)
                        h.mutable_geometry()->set_world_from_camera(
                            i, 1.01 * h.geometry().world_from_camera(i));
                },
                "not a rotation"},
        Spoiled{"PoseMirrored",
                [](auto& h) {
                    for (int i = 0; i < 3; ++i)
                        h.mutable_geometry()->set_world_from_camera(
                            i, -h.geometry().world_from_camera(i));
                },
                "not a rotation"},
        Spoiled{"PoseFarAway", [](auto& h) { h.mutable_geometry()->set_world_from_camera(3, 1e9); },
                "world_from_camera"},
        Spoiled{"DisparityHuge", [](auto& h) { h.set_disparity_width_px(5000); }, "5000x47"},
        Spoiled{"DisparityEmpty", [](auto& h) { h.set_disparity_height_px(0); }, "61x0"},
        Spoiled{"DisparityLargerThanColour", [](auto& h) { h.set_disparity_width_px(62); },
                "62x47"},
        Spoiled{"DisparityOfAnotherSize", [](auto& h) { h.set_disparity_width_px(60); },
                "disparity payload"},
        Spoiled{"ColourOfAnotherSize", [](auto& h) { h.mutable_geometry()->set_width_px(62); },
                "colour payload"},
        Spoiled{"ColourCodecUnknown",
                [](auto& h) { h.set_colour_codec(static_cast<wire::FrameHeader::ColourCodec>(9)); },
                "colour codec 9"},
        Spoiled{"DisparityCodecUnknown",
                [](auto& h) {
                    h.set_disparity_codec(static_cast<wire::FrameHeader::DisparityCodec>(-3));
                },
                "disparity codec -3"},
        Spoiled{"ColourCodecWrong",
                [](auto& h) { h.set_colour_codec(wire::FrameHeader::COLOUR_JPEG); }, "JPEG"},
        Spoiled{"ColourDenied", [](auto& h) { h.set_colour_codec(wire::FrameHeader::COLOUR_NONE); },
                "without colour"},
        Spoiled{"DisparityDenied",
                [](auto& h) { h.set_disparity_codec(wire::FrameHeader::DISPARITY_NONE); },
                "without disparity"},
        Spoiled{"MaxDisparity", [](auto& h) { h.set_max_disparity_px(1e9f); }, "max_disparity_px"},
        Spoiled{"StageTime",
                [](auto& h) {
                    h.mutable_times()->set_match_ms(std::numeric_limits<float>::quiet_NaN());
                },
                "match_ms"}),
    [](const auto& spoiled) { return std::string(spoiled.param.name); });

TEST(FrameCodec, EveryTruncationOfTheHeaderIsRefused) {
    RigFrame frame = make_frame(3);
    const PackedFrame whole = FrameEncoder(lossless).encode(frame);
    for (std::size_t size = 0; size < whole.header.size(); ++size) {
        PackedFrame cut = whole;
        cut.header.resize(size);
        EXPECT_NE(refusal_of(cut), "") << size;
    }
}

TEST(FrameCodec, PayloadsBeyondTheirPictureAreRefused) {
    RigFrame frame = make_frame(3);
    PackedFrame packed = FrameEncoder(lossless).encode(frame);
    packed.colour.resize(61 * 47 * 4 + payload_slack_bytes + 1);
    EXPECT_THAT(refusal_of(packed), HasSubstr("beyond the limit"));
    packed = FrameEncoder(lossless).encode(frame);
    packed.disparity.resize(61 * 47 * 2 + payload_slack_bytes + 1);
    EXPECT_THAT(refusal_of(packed), HasSubstr("beyond the limit"));
    packed = FrameEncoder(lossless).encode(frame);
    packed.header.resize(max_header_bytes + 1);
    EXPECT_THAT(refusal_of(packed), HasSubstr("beyond the limit"));
}

TEST(FrameCodec, TrailingBytesAreRefused) {
    RigFrame frame = make_frame(3);
    PackedFrame packed = FrameEncoder(lossless).encode(frame);
    packed.disparity.push_back(std::byte{1});
    EXPECT_THAT(refusal_of(packed), HasSubstr("damaged"));
}

}  // namespace
}  // namespace vantage
