#include <numbers>

#include "host_app/control/ports/tracking_sinks.h"
#include "host_app/control/tracking/freed_message.h"
#include "tests/unit/host_app/ports/bench_test.h"

namespace vantage {
namespace {

constexpr double deg = std::numbers::pi / 180;

CameraState some_camera() {
    CameraState camera;
    camera.world_from_camera.linear() = turned({30 * deg, -12 * deg, 5 * deg});
    camera.world_from_camera.translation() = Eigen::Vector3d(1.25, 1.7, -3.5);
    camera.field_of_view_rad = 40 * deg;
    camera.focus_m = 4.25;
    return camera;
}

TEST(FreedMessage, RoundTripsWithinItsSteps) {
    for (const double pan : {-179.0, -90.0, 0.0, 45.0, 179.0})
        for (const double tilt : {-89.0, -10.0, 0.0, 60.0})
            for (const double roll : {-170.0, -5.0, 0.0, 90.0}) {
                FreedCamera camera;
                camera.id = 7;
                camera.world_from_camera.linear() = turned({pan * deg, tilt * deg, roll * deg});
                camera.world_from_camera.translation() = Eigen::Vector3d(-100, 2.5, 130);
                camera.zoom = 0xfffffe;
                camera.focus = 12345;
                const auto back = decode_freed(encode_freed(camera));
                ASSERT_TRUE(back);
                EXPECT_EQ(back->id, 7);
                EXPECT_EQ(back->zoom, 0xfffffeu);
                EXPECT_EQ(back->focus, 12345u);
                EXPECT_LT(
                    (back->world_from_camera.linear() - camera.world_from_camera.linear()).norm(),
                    1e-5);
                EXPECT_LT(
                    (back->world_from_camera.translation() - camera.world_from_camera.translation())
                        .norm(),
                    1e-4);
            }
}

TEST(FreedMessage, ReadsAMessageThatIsWrittenDownByHand) {
    // Camera 1, pan 90 degrees, 1 m to the right, 2 m high.
    std::array<std::byte, freed_bytes> bytes{};
    const auto put = [&](std::size_t at, std::uint32_t value) {
        for (int i = 0; i < 3; ++i)
            bytes[at + static_cast<std::size_t>(i)] = static_cast<std::byte>(value >> (16 - 8 * i));
    };
    bytes[0] = std::byte{0xd1};
    bytes[1] = std::byte{1};
    put(2, 90 * 32768);
    put(11, 1000 * 64);
    put(17, 2000 * 64);
    unsigned sum = 0;
    for (const std::byte byte : bytes) sum += std::to_integer<unsigned>(byte);
    bytes[28] = static_cast<std::byte>((0x40 - sum) & 0xff);
    const auto camera = decode_freed(bytes);
    ASSERT_TRUE(camera);
    EXPECT_LT((camera->world_from_camera.linear().col(2) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-9)
        << "it looks to the right";
    EXPECT_LT((camera->world_from_camera.translation() - Eigen::Vector3d(1, 2, 0)).norm(), 1e-9);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        auto damaged = bytes;
        damaged[i] ^= std::byte{1};
        EXPECT_FALSE(decode_freed(damaged)) << "byte " << i;
    }
    EXPECT_FALSE(decode_freed(std::span(bytes).first(28)));
}

TEST(FreedMessage, NamesWhatIsWrongAndToleratesRounding) {
    FreedCamera camera = freed_camera(some_camera(), 1);
    camera.world_from_camera.linear() = turned({0, 90 * deg, 0});
    auto bytes = encode_freed(camera);
    const auto with_tilt = [&](std::uint32_t steps) {
        for (std::size_t i = 0; i < 3; ++i)
            bytes[5 + i] = static_cast<std::byte>(steps >> (16 - 8 * i));
        unsigned sum = 0;
        for (std::size_t i = 0; i + 1 < bytes.size(); ++i)
            sum += std::to_integer<unsigned>(bytes[i]);
        bytes[28] = static_cast<std::byte>((0x40 - sum) & 0xff);
        return read_freed(bytes);
    };
    EXPECT_TRUE(with_tilt(90 * 32768 + 1).camera) << "90.00003 degrees";
    EXPECT_NE(with_tilt(95 * 32768).fault.find("tilt of 95.00 degrees"), std::string::npos);
    bytes[28] ^= std::byte{1};
    EXPECT_NE(read_freed(bytes).fault.find("checksum"), std::string::npos);
    EXPECT_NE(read_freed(std::span(bytes).first(28)).fault.find("28 bytes"), std::string::npos);
    bytes[0] = std::byte{0xd0};
    EXPECT_NE(read_freed(bytes).fault.find("type 0xd0"), std::string::npos);
}

TEST_F(BenchTest, WhatALensIsTakenForIsToldOnce) {
    FreedCamera message = freed_camera(some_camera(), 3);
    message.zoom = 9000;
    const auto bytes = encode_freed(message);
    const auto port = open("freed");
    testing::internal::CaptureStderr();
    std::string two(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    peer_.send(two + two, number_);
    serve(*port, 2);
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_EQ(port->stats().obeyed, 2u) << "both of one datagram";
    const std::size_t first = log.find("zoom 9000 is taken as a field of view of 9 degrees");
    EXPECT_NE(first, std::string::npos) << log;
    EXPECT_EQ(log.find("zoom 9000", first + 1), std::string::npos);
}

TEST_F(BenchTest, ATrackedCameraComesInAsItWentOut) {
    const auto port = open("freed", "?camera=3");
    const auto sink =
        make_tracking_sink(fmt::format("freed://127.0.0.1:{}?camera=3", number_), 25, 25);
    ProgrammePicture picture;
    picture.camera = some_camera();
    picture.due = MonotonicClock::now() + std::chrono::hours(1);  // no tick after it is late
    sink->take(picture);
    serve(*port, 1);
    ASSERT_EQ(port->stats().obeyed, 1u) << port->stats().last_refusal;
    const auto heard = tracked_.newest(MonotonicClock::now());
    ASSERT_TRUE(heard);
    EXPECT_TRUE(is_same_view(*heard, some_camera()));
    EXPECT_NEAR(heard->focus_m, 4.25, 1e-3);
    const auto other = make_tracking_sink(fmt::format("freed://127.0.0.1:{}", number_), 25, 25);
    other->take(picture);
    other->finish();
    peer_.send("damaged", number_);
    serve(*port, 3);
    EXPECT_EQ(port->stats().unknown, 1u) << "camera 1";
    EXPECT_EQ(port->stats().malformed, 1u);
}

TEST_F(BenchTest, ALensThatSaysNoFieldOfViewNeedsOne) {
    const CameraState camera = some_camera();
    FreedCamera message = freed_camera(camera, 1);
    message.zoom = 1000;  // an encoder's
    const auto bytes = encode_freed(message);
    {
        const auto port = open("freed");
        peer_.send(bytes.data(), bytes.size(), number_);
        serve(*port, 1);
        EXPECT_EQ(port->stats().malformed, 1u);
        EXPECT_NE(port->stats().last_refusal.find("fov="), std::string::npos);
        EXPECT_FALSE(tracked_.newest(MonotonicClock::now()));
    }
    const auto port = open("freed", "?fov=60");
    peer_.send(bytes.data(), bytes.size(), number_);
    serve(*port, 1);
    const auto heard = tracked_.newest(MonotonicClock::now());
    ASSERT_TRUE(heard);
    EXPECT_NEAR(heard->field_of_view_rad, 60 * deg, 1e-9);
}

}  // namespace
}  // namespace vantage
