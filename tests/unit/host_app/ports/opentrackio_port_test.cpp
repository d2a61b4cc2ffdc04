#include <fstream>
#include <numbers>
#include <sstream>

#include <nlohmann/json.hpp>

#include "host_app/control/ports/tracking_sinks.h"
#include "host_app/control/tracking/opentrackio_sample.h"
#include "host_app/flight/orbit_view.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/ports/bench_test.h"

namespace vantage {
namespace {

constexpr double degree = std::numbers::pi / 180;

CameraState tilted_camera() {
    CameraState camera;
    camera.world_from_camera.linear() = turned({30 * degree, -12 * degree, 5 * degree});
    camera.world_from_camera.translation() = Eigen::Vector3d(1.25, 1.7, -3.5);
    camera.field_of_view_rad = 40 * degree;
    camera.focus_m = 4.25;
    return camera;
}

OpentrackioSample some_sample() {
    OpentrackioSample sample;
    sample.camera = tilted_camera();
    sample.source = 7;
    sample.source_id = uuid_urn(0x0123456789abcdef, 0);
    sample.sample_id = uuid_urn(0x0123456789abcdef, 1);
    sample.width_px = 1280;
    sample.height_px = 720;
    sample.rate = {60000, 1001};
    sample.time = tai_from_ns(1'700'000'000'250'000'000);
    sample.sequence = 99;
    sample.timecode = SmpteCode{1, 2, 3, 40, true};
    sample.ptp_locked = true;
    return sample;
}

std::span<const std::byte> bytes_of_text(std::string_view text) {
    return std::as_bytes(std::span(text));
}

OpentrackioCameraReading read_text(std::string_view text) {
    return read_opentrackio_sample(bytes_of_text(text), OpentrackioEncoding::json);
}

std::filesystem::path standard_folder() {
    return data_folder().value_or("/nowhere") / "opentrackio";
}

std::string file_text(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(OpentrackioPacket, HasTheHeaderOfTheStandard) {
    const auto packets =
        opentrackio_packets(bytes_of_text("abcde"), OpentrackioEncoding::cbor, 0x0102);
    ASSERT_EQ(packets.size(), 1u);
    const std::vector<std::byte>& packet = packets[0];
    ASSERT_EQ(packet.size(), 21u);
    const std::array<int, 14> header{'O', 'T', 'r', 'k', 0, 2, 1, 2, 0, 0, 0, 0, 0x80, 5};
    for (std::size_t i = 0; i < header.size(); ++i)
        EXPECT_EQ(std::to_integer<int>(packet[i]), header[i]) << i;
    // 97 + 98 + ... and the sums of these sums, modulo 256.
    EXPECT_EQ(opentrackio_checksum({}, bytes_of_text("abcde")), 0xc3ef);
    EXPECT_EQ(opentrackio_checksum(std::span(packet).first(14), bytes_of_text("abcde")),
              std::to_integer<int>(packet[14]) << 8 | std::to_integer<int>(packet[15]));
    for (std::size_t i = 0; i < packet.size(); ++i) {
        if (i == 4) continue;
        std::vector<std::byte> damaged = packet;
        damaged[i] ^= std::byte{1};
        EXPECT_FALSE(read_opentrackio_packet(damaged).packet) << i;
    }
}

TEST(OpentrackioPacket, NamesWhatIsWrong) {
    const auto fault = [](std::span<const std::byte> bytes) {
        return read_opentrackio_packet(bytes).fault;
    };
    EXPECT_NE(fault(bytes_of_text("OTrk")).find("4 bytes"), std::string::npos);
    EXPECT_NE(fault(bytes_of_text("{\"protocol\":{\"name\":1}}")).find("does not begin with OTrk"),
              std::string::npos);
    auto packet = opentrackio_packets(bytes_of_text("abcde"), OpentrackioEncoding::json, 1)[0];
    packet.pop_back();
    EXPECT_NE(fault(packet).find("4 bytes behind its header, which says 5"), std::string::npos);
    const std::vector<std::byte> large(most_opentrackio_bytes + 1);
    const auto packets = opentrackio_packets(large, OpentrackioEncoding::json, 1);
    EXPECT_NE(fault(packets.back()).find("8193 bytes"), std::string::npos);
    auto vendor = opentrackio_packets(bytes_of_text("a"), OpentrackioEncoding{0x80}, 1)[0];
    EXPECT_NE(fault(vendor).find("the encoding 128"), std::string::npos);
}

TEST(OpentrackioAssembler, JoinsSegmentsInAnyOrder) {
    const std::string text = "0123456789abcdef";
    const auto packets = opentrackio_packets(bytes_of_text(text), OpentrackioEncoding::json, 5, 6);
    ASSERT_EQ(packets.size(), 3u);
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
        OpentrackioAssembler assembler;
        std::string fault;
        std::optional<OpentrackioAssembler::Sample> sample;
        for (const std::size_t i : order) {
            EXPECT_FALSE(sample);
            sample = assembler.add("a", *read_opentrackio_packet(packets[i]).packet, fault);
        }
        ASSERT_TRUE(sample) << fault;
        EXPECT_TRUE(std::ranges::equal(sample->bytes, bytes_of_text(text)));
        EXPECT_EQ(fault, "");
    } while (std::ranges::next_permutation(order).found);
}

TEST(OpentrackioAssembler, TellsOfIncompleteSamplesAndKeepsSendersApart) {
    const auto packets_of = [](std::uint16_t sequence) {
        return opentrackio_packets(bytes_of_text("0123456789"), OpentrackioEncoding::json, sequence,
                                   6);
    };
    const auto first = packets_of(1), second = packets_of(2);
    OpentrackioAssembler assembler;
    std::string fault;
    const auto add = [&](const char* sender, const std::vector<std::byte>& packet) {
        return assembler.add(sender, *read_opentrackio_packet(packet).packet, fault).has_value();
    };
    EXPECT_FALSE(add("a", first[0]));
    EXPECT_FALSE(add("b", second[0]));
    EXPECT_EQ(fault, "");
    EXPECT_TRUE(add("b", second[1]));
    EXPECT_FALSE(add("a", second[1]));
    EXPECT_NE(fault.find("6 bytes came, and the rest did not"), std::string::npos) << fault;
    EXPECT_TRUE(add("a", second[0]));
}

TEST(OpentrackioSample, ComesInAsItWentOut) {
    for (const auto encoding : {OpentrackioEncoding::json, OpentrackioEncoding::cbor}) {
        const std::vector<std::byte> bytes = write_opentrackio_sample(some_sample(), encoding);
        EXPECT_LE(bytes.size(), opentrackio_segment_bytes) << "it fits into one packet";
        const auto reading = read_opentrackio_sample(bytes, encoding);
        ASSERT_TRUE(reading.camera) << reading.fault;
        EXPECT_TRUE(
            reading.camera->world_from_camera.isApprox(tilted_camera().world_from_camera, 1e-9));
        EXPECT_EQ(reading.camera->source, 7u);
        EXPECT_NEAR(*reading.camera->focus_m, 4.25, 1e-9);
        EXPECT_NEAR(
            2 * std::atan(*reading.camera->sensor_width_mm / 2 / *reading.camera->focal_length_mm),
            40 * degree, 1e-9);
    }
}

TEST(OpentrackioSample, HasTheAxesOfTheStandard) {
    // By hand: 2 m forward (y), 1 m up, turned by 90 degrees to the left (positive about z).
    const auto reading = read_text(R"({"transforms": [{"translation": {"y": 2, "z": 1},
        "rotation": {"pan": 90}}], "lens": {"pinholeFocalLength": 18}})");
    ASSERT_TRUE(reading.camera) << reading.fault;
    const Pose& pose = reading.camera->world_from_camera;
    EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(0, 1, -2)));
    EXPECT_TRUE(pose.linear().col(2).isApprox(Eigen::Vector3d(-1, 0, 0))) << "it looks to the left";
    EXPECT_TRUE(pose.linear().col(1).isApprox(Eigen::Vector3d(0, -1, 0))) << "and stands upright";
    // Tilted up; and rolled clockwise, so that its right side is down.
    const auto tilt = read_text(R"({"transforms": [{"rotation": {"tilt": 30}}]})");
    EXPECT_NEAR(tilt.camera->world_from_camera.linear().col(2).y(), 0.5, 1e-9);
    const auto roll = read_text(R"({"transforms": [{"rotation": {"roll": 30}}]})");
    EXPECT_NEAR(roll.camera->world_from_camera.linear().col(0).y(), -0.5, 1e-9);
}

TEST(OpentrackioSample, ComposesTransforms) {
    // A dolly 3 m to the right that is turned to the left, and a head 1 m before it.
    const auto reading = read_text(R"({"transforms": [
        {"translation": {"x": 3}, "rotation": {"pan": 90}, "id": "Dolly"},
        {"translation": {"y": 1}, "rotation": {"pan": -90}, "id": "Head"}]})");
    ASSERT_TRUE(reading.camera) << reading.fault;
    EXPECT_TRUE(reading.camera->world_from_camera.translation().isApprox(Eigen::Vector3d(2, 0, 0)));
    EXPECT_TRUE(
        reading.camera->world_from_camera.linear().col(2).isApprox(Eigen::Vector3d(0, 0, -1)));
}

TEST(OpentrackioSample, RefusesWhatIsNoCamera) {
    for (const char* text : {"", "[]", "{", "{}", R"({"transforms": []})", R"({"transforms": [1]})",
                             R"({"transforms": [{"translation": {"x": "1"}}]})",
                             R"({"transforms": [{"translation": {"x": 1e300}}]})"}) {
        const auto reading = read_text(text);
        EXPECT_FALSE(reading.camera) << text;
        EXPECT_NE(reading.fault, "") << text;
    }
    // Nested without end, in both encodings.
    const std::string json(most_opentrackio_bytes, '[');
    EXPECT_FALSE(read_text(json).camera);
    for (const unsigned char opened : {0x81, 0x9f, 0x7f, 0x5f, 0xc1}) {
        const std::string cbor(most_opentrackio_bytes, static_cast<char>(opened));
        EXPECT_FALSE(
            read_opentrackio_sample(bytes_of_text(cbor), OpentrackioEncoding::cbor).camera);
    }
}

TEST(OpentrackioSample, ReadsTheExamplesOfTheStandard) {
    if (!std::filesystem::exists(standard_folder()))
        GTEST_SKIP() << "SKIPPED: no examples in the data";
    for (const char* name : {"recommended_dynamic_example", "recommended_static_example",
                             "complete_dynamic_example"}) {
        const std::string text = file_text(standard_folder() / (std::string(name) + ".json"));
        const auto reading = read_text(text);
        ASSERT_TRUE(reading.camera) << name << ": " << reading.fault;
        EXPECT_NEAR(*reading.camera->focal_length_mm, 24.305, 1e-9);
        EXPECT_EQ(reading.camera->sensor_width_mm.has_value(),
                  std::string(name) == "recommended_static_example");
        const std::vector<std::uint8_t> cbor = nlohmann::json::to_cbor(nlohmann::json::parse(text));
        const auto again =
            read_opentrackio_sample(std::as_bytes(std::span(cbor)), OpentrackioEncoding::cbor);
        ASSERT_TRUE(again.camera) << name << ": " << again.fault;
        EXPECT_TRUE(again.camera->world_from_camera.isApprox(reading.camera->world_from_camera));
    }
}

TEST(OpentrackioSample, FitsTheSchemaOfTheStandard) {
    if (!std::filesystem::exists(standard_folder()))
        GTEST_SKIP() << "SKIPPED: no schema in the data";
    const TemporaryFolder folder;
    OpentrackioSample least = some_sample();
    least.timecode.reset();
    least.ptp_locked.reset();
    std::vector<std::string> files;
    const auto write = [&](const OpentrackioSample& sample, OpentrackioEncoding encoding) {
        const std::vector<std::byte> bytes = write_opentrackio_sample(sample, encoding);
        const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
        const nlohmann::json json = encoding == OpentrackioEncoding::cbor
                                        ? nlohmann::json::from_cbor(begin, begin + bytes.size())
                                        : nlohmann::json::parse(begin, begin + bytes.size());
        files.push_back((folder.path() / fmt::format("{}.json", files.size())).string());
        std::ofstream(files.back()) << json.dump();
        return json;
    };
    for (const auto encoding : {OpentrackioEncoding::json, OpentrackioEncoding::cbor}) {
        const nlohmann::json json = write(some_sample(), encoding);
        EXPECT_EQ(json["timing"]["timecode"]["frames"], 40);
        EXPECT_EQ(json["timing"]["timecode"]["dropFrame"], true);
        EXPECT_EQ(json["timing"]["sampleTimestamp"]["seconds"], 1'700'000'000);
        EXPECT_EQ(json["timing"]["sampleTimestamp"]["nanoseconds"], 250'000'000);
        EXPECT_EQ(json["timing"]["sampleRate"]["num"], 60000);
        EXPECT_EQ(json["timing"]["sequenceNumber"], 99);
        write(least, encoding);
    }
    std::vector<std::string> arguments{
        "-c",
        "import json, sys\n"
        "try: import jsonschema\n"
        "except ImportError: sys.exit(77)\n"
        "schema = json.load(open(sys.argv[1]))\n"
        "for name in sys.argv[2:]: jsonschema.validate(json.load(open(name)), schema)",
        (standard_folder() / "schema.json").string()};
    arguments.insert(arguments.end(), files.begin(), files.end());
    const ProgramResult result = run_to_end("/usr/bin/python3", arguments);
    constexpr int no_package = 77;
    if (result.status == no_package) GTEST_SKIP() << "SKIPPED: python3-jsonschema is missing";
    EXPECT_EQ(result.status, 0) << result.err;
}

TEST_F(BenchTest, OpentrackioOutputFliesOpentrackioControl) {
    for (const char* format : {"json", "cbor"}) {
        const auto port = open("opentrackio", "?source=3");
        const auto sink = make_tracking_sink(
            fmt::format("opentrackio://127.0.0.1:{}?source=3&format={}", number_, format), 50, 25);
        ProgrammePicture picture;
        picture.camera = tilted_camera();
        picture.picture = ColourImage(72, 128);
        picture.due = MonotonicClock::now() + std::chrono::hours(1);  // no tick after it is late
        sink->take(picture);
        serve(*port, 1);
        ASSERT_EQ(port->stats().obeyed, 1u) << port->stats().last_refusal;
        const auto flown = tracked_.newest(MonotonicClock::now());
        ASSERT_TRUE(flown);
        EXPECT_TRUE(is_same_view(*flown, tilted_camera()));
        EXPECT_NEAR(flown->focus_m, 4.25, 1e-6);
        const auto other =
            make_tracking_sink(fmt::format("opentrackio://127.0.0.1:{}", number_), 50, 25);
        other->take(picture);
        other->finish();
        peer_.send("damaged", number_);
        serve(*port, 3);
        EXPECT_EQ(port->stats().unknown, 1u) << "source 1";
        EXPECT_EQ(port->stats().malformed, 1u);
    }
}

TEST_F(BenchTest, OpentrackioControlRemembersTheSensorAndJoinsSegments) {
    const auto send = [&](std::string_view text, std::uint16_t sequence) {
        for (const auto& packet :
             opentrackio_packets(bytes_of_text(text), OpentrackioEncoding::json, sequence, 40))
            peer_.send(packet.data(), packet.size(), number_);
    };
    const auto port = open("opentrackio");
    const std::string dynamic =
        R"("lens": {"pinholeFocalLength": 18}, "transforms": [{"translation": {"z": 2}}]})";
    send("{" + dynamic, 1);
    serve(*port, 1);
    EXPECT_EQ(port->stats().malformed, 1u);
    EXPECT_NE(port->stats().last_refusal.find("sensor-mm="), std::string::npos)
        << port->stats().last_refusal;
    send(R"({"static": {"camera": {"activeSensorPhysicalDimensions":
         {"width": 36, "height": 24}}}, )" +
             dynamic,
         2);
    send("{" + dynamic, 3);
    serve(*port, 3);
    EXPECT_EQ(port->stats().obeyed, 2u) << port->stats().last_refusal;
    const auto flown = tracked_.newest(MonotonicClock::now());
    ASSERT_TRUE(flown);
    EXPECT_NEAR(flown->field_of_view_rad, 90 * degree, 1e-9);
    send(R"({"lens": {"pinholeFocalLength": 1800}, "transforms": [{}]})", 4);
    serve(*port, 4);
    EXPECT_NE(port->stats().last_refusal.find("field of view of 1.1 degrees"), std::string::npos)
        << port->stats().last_refusal;
}

TEST_F(BenchTest, OpentrackioUrlsAreChecked) {
    const auto sink = [](const std::string& url) {
        return thrown_sentence([&] { make_tracking_sink("opentrackio://" + url, 25, 25); });
    };
    const auto place = [](const std::string& url) {
        return with_opentrackio_group(OutputUrl::parse("opentrackio://" + url)).place;
    };
    EXPECT_EQ(place("multicast"), "239.135.1.1:55555");
    EXPECT_EQ(place("multicast?source=200"), "239.135.1.200:55555");
    EXPECT_EQ(place("10.0.0.1:5000?source=3"), "10.0.0.1:5000");
    EXPECT_EQ(sink("multicast?source=200&sensor-mm=24"), "");
    EXPECT_NE(sink("multicast?source=201").find("source"), std::string::npos);
    EXPECT_NE(sink("127.0.0.1:1?format=xml").find("json"), std::string::npos);
    EXPECT_NE(sink("127.0.0.1:1?camera=1").find("no option 'camera'"), std::string::npos);
    EXPECT_NE(
        thrown_sentence([&] { open_port("opentrackio://multicast", bench_); }).find("say open=yes"),
        std::string::npos);
}

}  // namespace
}  // namespace vantage
