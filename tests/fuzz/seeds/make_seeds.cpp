// make_seeds FOLDER: writes the first inputs of every fuzz target to FOLDER/TARGET/.

#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "common/base/files/atomic_file.h"
#include "common/calibration_forms/calibration_form.h"
#include "common/config/calibration_file.h"
#include "common/datagrams/frame_packets.h"
#include "common/image/pfm.h"
#include "common/image/png.h"
#include "common/pairing/pair_code.h"
#include "common/take/format/frame_storage.h"
#include "common/take/kept_frame.h"
#include "common/wire/codec/colour_codec.h"
#include "common/wire/codec/disparity_codec.h"
#include "common/wire/curve_keys.h"
#include "common/wire/link_message.h"
#include "host_app/background/background_file.h"
#include "host_app/control/tracking/opentrackio_sample.h"
#include "host_app/ltc/ltc_sound.h"
#include "tests/fuzz/seeds/seed_frames.h"

namespace vantage {
namespace {

class Seeds {
  public:
    explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {}

    std::filesystem::path place(std::string_view target, std::string_view name) const {
        std::filesystem::create_directories(folder_ / target);
        return folder_ / target / name;
    }
    void write(std::string_view target, std::string_view name,
               std::span<const std::byte> bytes) const {
        write_file_atomically(place(target, name), bytes);
    }
    void write(std::string_view target, std::string_view name, std::string_view text) const {
        write(target, name, std::as_bytes(std::span(text)));
    }

  private:
    std::filesystem::path folder_;
};

void write_frames(const Seeds& seeds) {
    constexpr int lossless = 0;
    for (const int quality : {lossless, 85}) {
        RigFrame frame = seed_frame();
        const PackedFrame packed = FrameEncoder(quality).encode(frame);
        seeds.write("frame_decoder", "whole-" + std::to_string(quality), join_frame(packed));
    }
    RigFrame with_right = seed_frame();
    with_right.right = with_right.colour;
    seeds.write("frame_decoder", "right-picture", join_frame(FrameEncoder(85).encode(with_right)));
    RigFrame pair = seed_frame();
    pair.content = RigFrame::Content::raw_pair;
    pair.right = pair.colour;
    pair.disparity = DisparityImage();
    seeds.write("frame_decoder", "raw-pair", join_frame(FrameEncoder(lossless).encode(pair)));
    RigFrame frame = seed_frame();
    frame.colour = ColourImage();
    frame.disparity = frame.disparity(cv::Rect(0, 0, 7, 5));
    seeds.write("frame_decoder", "disparity-only",
                join_frame(FrameEncoder(lossless).encode(frame)));
}

/// A payload behind the two bytes that say its size, less one.
std::vector<std::byte> with_size(int width, int height, std::vector<std::byte> payload) {
    payload.insert(payload.begin(),
                   {static_cast<std::byte>(width - 1), static_cast<std::byte>(height - 1)});
    return payload;
}

void write_pictures(const Seeds& seeds) {
    const RigFrame frame = seed_frame();
    const int width = frame.colour.cols;
    const int height = frame.colour.rows;
    seeds.write("disparity_codec", "plain",
                with_size(width, height, DisparityEncoder().encode(frame.disparity)));
    seeds.write("colour_codec", "lossless",
                with_size(width, height, LosslessColourEncoder().encode(frame.colour)));
    seeds.write("colour_codec", "jpeg",
                with_size(width, height, JpegEncoder().encode(frame.colour, 85, Chroma::quarter)));
    write_pfm(seeds.place("pfm", "plain"), cv::Mat1f(3, 4, 2.0f));
    seeds.write("picture", "pgm", "P5 # comment\n2 1\n255\nab");
    seeds.write("picture", "ppm", std::string("P6\n1 1 65535\nabcdef"));
    const auto write_png = [&](const char* name, const cv::Mat& picture) {
        const std::vector<std::byte> bytes = encode_png(picture);
        seeds.write("picture", name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    write_png("png_grey", cv::Mat1b(3, 4, uchar{7}));
    write_png("png_wide", cv::Mat1w(3, 4, ushort{700}));
    write_png("png_colour", cv::Mat3b(3, 4, cv::Vec3b(1, 2, 3)));
}

void write_messages(const Seeds& seeds) {
    seeds.write("link_message", "host", encode(HostMessage{1, 2, 3, 4, true, 5, 6}));
    HostMessage fetching{1, 2, 3, 4, false, 5, 6};
    fetching.fetch = {7, 8, 9, 10};
    seeds.write("link_message", "fetch", encode(fetching));
    RigMessage message;
    message.rig = "rig-a";
    message.session = 1;
    message.link = 2;
    message.counters = {10, 5, 3, 2};
    seeds.write("link_message", "rig", encode(message));
    message.fetch = {7, 1, true, "a trouble"};
    seeds.write("link_message", "fetched", encode(message));
    message.refusal = "no";
    seeds.write("link_message", "refusal", encode(message));
    message.refusal.clear();
    message.offer = {7, 5600, "a passphrase of a seed"};
    message.sent_by_datagrams = 3;
    message.datagram_trouble = "a trouble";
    const std::vector<std::byte> head = encode(message);
    seeds.write("link_message", "offer", head);
    std::vector<std::byte> packets;
    const auto append = [&](std::span<const std::byte> packet) {
        packets.push_back(static_cast<std::byte>((packet_bytes - packet.size()) / 6));
        packets.insert(packets.end(), packet.begin(), packet.end());
        return true;
    };
    const std::vector<std::byte> colour(3000, std::byte{7});
    cut_message(join_parts({head, head, colour, {}}, message.offer.passphrase), 0, append);
    seeds.write("frame_packets", "frame", packets);
}

void write_pairing(const Seeds& seeds) {
    const std::string key = generate_curve_keys().public_key;
    const PairBytes nonce = random_pair_bytes();
    seeds.write("pair_message", "commit", encode(PairCommit{nonce}));
    seeds.write("pair_message", "offer", encode(PairOffer{"rig-a", key, nonce, 5600, 30}));
    seeds.write("pair_message", "reveal", encode(PairReveal{"host", key, nonce}));
    seeds.write("pair_message", "confirm", encode(PairConfirm{nonce}));
    seeds.write("pair_message", "refusal", encode(PairRefusal{"no"}));
}

void write_configurations(const Seeds& seeds) {
    const CurveKeys keys = generate_curve_keys();
    seeds.write("key_file", "pair",
                "version = 1\npublic = \"" + keys.public_key + "\"\nsecret = \"" + keys.secret_key +
                    "\"\n");
    seeds.write("key_file", "hosts", "# hosts\n" + keys.public_key + " gallery\n");
    seeds.write("rig_config", "all", R"(version = 1
name = "rig-a"
calibration = "c.yaml"
[source]
kind = "virtual"
rate_hz = 30.0
width_px = 320
height_px = 240
seed = 1
noise_sigma = 0.5
left = "l%04d.png"
first = 1
loop = true
controls = { exposure = 3 }
[virtual_rig]
azimuth_deg = 10.0
elevation_deg = 5
[match]
preset = "fast"
disparities = 32
[stream]
bind = "tcp://127.0.0.1:5600"
jpeg_quality = 85
chroma = "4:4:4"
queue_frames = 4
key_file = "k"
authorized_hosts = "h"
)");
    seeds.write("colour_file", "good", R"(version = 1
date = "2026-01-01"
tool = "t"
reference = "A"
delta_e_before = 5.5
delta_e_after = 0.5
samples = 24
matrix = [1.1, 0.05, -0.02, 0.03, 0.95, 0.01, 0, -0.04, 0.8]
tone = [1.05, 0.97, 1.2]
)");
    seeds.write("sync_file", "good", R"(%YAML:1.0
---
kind: vantage synchronisation
version: 1
units: "milliseconds, hertz; skews are of the centres of exposures, positive: later than the reference"
date: "2026-11-23T16:41:46Z"
tool: vantage-calib sync
rate_hz: 20.
bar_step_ms: 1.2700000000000000e-01
reference: A left
checksum: "fnv1a64:e28e610a422ca8cc"
sensors:
   -
      rig: A
      side: left
      skew_ms: 0.
      sigma_ms: 0.
      exposure_ms: 4.9998971314003544e+00
      pictures: 20
      strays: 0
      pulses_apart: 0
   -
      rig: A
      side: right
      skew_ms: 8.4022204438578871e+00
      sigma_ms: 3.4773603902934088e-03
      exposure_ms: 5.0030889459525945e+00
      pictures: 20
      strays: 0
      pulses_apart: 0
)");
    seeds.write(
        "health_history", "two",
        R"({"version":1,"date":"d","measures":[{"what":"rows","rigs":"A","value":0.1,"verdict":"good"}]}
{"version":1,"date":"e","measures":[]}
)");
    seeds.write("stage_config", "all",
                "version = 1\nkey_file = \"k\"\nrate_hz = 30\n"
                "latency_budget_ms = 200\n[[rigs]]\nname = \"rig-a\"\n"
                "endpoint = \"tcp://127.0.0.1:5600\"\npublic_key = \"" +
                    keys.public_key +
                    "\"\n[view]\nwidth_px = 1280\n"
                    "target_m = [0.0, 1.0, 0.0]\nsynthesiser = \"mesh\"\n");
    seeds.write("move_file", "two", R"(version = 1
loop = false
path = "free"
lowest_m = -1
[[keyframe]]
time_s = 0.0
take_s = 0.5
azimuth_deg = 0.0
distance_m = 4.5
easing = "ease"
[[keyframe]]
time_s = 2.0
take_s = 0.5
eye_m = [0.0, 1.0, 4.0]
pan_deg = 20.0
tilt_deg = -5
focus_m = 3
[[shot]]
number = 3
name = "wide"
duration_s = 2
eye_m = [0.0, 1.0, 4.0]
target_m = [0.0, 1.0, 0.0]
)");
    seeds.write("camera_path", "colmap",
                "\1# images\n1 1 0 0 0 0 0 5 1 a.png\n\n\n--\n1 PINHOLE 64 48 50 50 32 24\n");
    seeds.write("camera_path", "omaf",
                R"({"cameras": [{"Name": "v0", "Projection": "Perspective",)"
                R"("Position": [0, 0, 1], "Rotation": [0, 0, 0],)"
                R"("Resolution": [64, 48], "Focal": [50, 50]}]})");
    seeds.write(
        "camera_path", "gltf",
        "\3{\"nodes\": [{\"camera\": 0}], \"cameras\": [{\"perspective\": {\"yfov\": 0.7}}],"
        "\"animations\": [{\"channels\": [{\"sampler\": 0, \"target\": {\"node\": 0, "
        "\"path\": \"translation\"}}], \"samplers\": [{\"input\": 0, \"output\": 1}]}],"
        "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 1, \"type\": "
        "\"SCALAR\"}, {\"bufferView\": 0, \"componentType\": 5126, \"count\": 1, \"type\": "
        "\"VEC3\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 12}], \"buffers\": "
        "[{\"byteLength\": 12, \"uri\": \"data:;base64,AAAAAAAAAAAAAAAA\"}]}");
    constexpr std::string_view matrices =
        R"("K": [[5,0,2],[0,5,1],[0,0,1]], "world_from_camera": [[1,0,0,0],[0,1,0,0],[0,0,1,0]])";
    seeds.write("view_set", "views",
                R"({"version": 1, "views": [{"name": "a", "image": "p.png",
"disparity": "d.pfm", "scale": 1, "unknown": 0, "baseline_m": 0.1, "doffs_px": 1, )" +
                    std::string(matrices) + "}]}");
    seeds.write("view_set", "pose", R"({"width": 4, "height": 3, )" + std::string(matrices) + "}");
    seeds.write("view_set", "pose_toml",
                "width = 4\nheight = 3\nK = [[5,0,2],[0,5,1],[0,0,1]]\n"
                "world_from_camera = [[1,0,0,0],[0,1,0,0],[0,0,1,0]]\n");
}

void write_controls(const Seeds& seeds) {
    using namespace std::string_view_literals;
    seeds.write(
        "osc_message", "numbers",
        "/vantage/shot\0\0\0,ihfdTFs\0\0\0\0\0\0\0\3\0\0\0\0\0\0\0\1\x3f\x80\0\0\x3f\xf0\0\0\0\0\0\0go\0\0"sv);
    seeds.write("osc_message", "bundle",
                "#bundle\0\0\0\0\0\0\0\0\1\0\0\0\x14/vantage/live\0\0\0,\0\0\0"sv);
    seeds.write("rosstalk_line", "lines", "GPI 3\r\nXPT 1:2\r\nMEM 4\r\nGPI -1\r\n");
    seeds.write("output_url", "srt",
                "srt://[::1]:9000?mode=listener&passphrase=ten%20letters&latency=120ms");
    seeds.write("output_url", "film", "a film.mkv?segment=60s&bitrate=6M");
    seeds.write("output_url", "pipe", "-?format=y4m");
    seeds.write("time_label", "drop_frame", "02:59:59;29");
    seeds.write("time_label", "offset", "01:00:10:12+01:00");
    seeds.write("time_label", "back", "-3.5");
    seeds.write("midi_message", "pad_encoder_bend",
                "\0\1\x24\x64\0\0\0\1\1\x10\x7f\0\0\0\2\1\0\0\x10\0\0"sv);
    seeds.write("midi_map", "one_of_each",
                "version = 1\n[buttons]\n\"note 36\" = \"shot 1\"\n[axes.\"cc 1 ch 2\"]\n"
                "action = \"orbit\"\nbits = 14\n[lamps.\"note 36\"]\nlamp = \"hold\"\non = 5\n");
    seeds.write("clip_file", "two",
                "version = 1\npulse_rate_hz = 25\nprogramme_speed = 0.5\nlist_loops = true\n"
                "[[clip]]\nnumber = 1\nname = \"leap\"\nin_pulse = 5\nout_pulse = 9\n"
                "speed = 0.5\nguard_s = 2\nshot = 3\n[[entry]]\nclip = 1\nspeed = 2\n");
    seeds.write("desk_file", "arranged",
                "version = 1\npanels = true\nrigs = false\noutside = true\n[eye]\n"
                "azimuth_deg = 30\nelevation_deg = 20\nnearness = 0.5\n[window]\nx = 0\n"
                "y = 0\nwidth = 1280\nheight = 720\nmaximised = false\n");
    seeds.write("tsl_message", "v3",
                "\x85\x31"
                "CAMERA 5        "sv);
    seeds.write("tsl_message", "v5", "\x0d\0\0\0\0\0\5\0\1\0\3\0VIR"sv);
    seeds.write("tsl_message", "tcp", "\xfe\x02\x0d\0\0\0\0\0\5\0\1\0\3\0VIR"sv);
    seeds.write(
        "camera_path", "freed",
        "\0\xd1\1\x2d\0\0\xfa\0\0\2\x80\0\0\xfa\0\2\x71\0\1\x38\x80\0\x9c\x40\0\x11\x94\0\0\xf9"sv);
    seeds.write(
        "freed_message", "d1",
        "\xd1\1\x2d\0\0\xfa\0\0\2\x80\0\0\xfa\0\2\x71\0\1\x38\x80\0\x9c\x40\0\x11\x94\0\0\xf9"sv);
}

/// Datagrams of a sample, each behind its length in two bytes, as opentrackio_fuzz.cpp reads them.
void write_opentrackio(const Seeds& seeds) {
    OpentrackioSample sample;
    sample.width_px = 1280;
    sample.height_px = 720;
    sample.rate = {60000, 1001};
    sample.timecode = SmpteCode{1, 2, 3, 4, true};
    sample.ptp_locked = true;
    sample.source_id = uuid_urn(1, 0);
    sample.sample_id = uuid_urn(1, 1);
    for (const OpentrackioEncoding encoding :
         {OpentrackioEncoding::json, OpentrackioEncoding::cbor}) {
        const std::string name = encoding == OpentrackioEncoding::json ? "json" : "cbor";
        const std::vector<std::byte> bytes = write_opentrackio_sample(sample, encoding);
        for (const std::size_t segment : {opentrackio_segment_bytes, std::size_t{200}}) {
            std::string text;
            for (const auto& packet : opentrackio_packets(bytes, encoding, 7, segment)) {
                text += static_cast<char>(packet.size() >> 8);
                text += static_cast<char>(packet.size() & 0xff);
                text.append(reinterpret_cast<const char*>(packet.data()), packet.size());
            }
            seeds.write("opentrackio", fmt::format("{}_{}", name, segment), text);
        }
    }
}

/// Requests in lines and as bytes, as web_request_fuzz.cpp reads them.
void write_web_requests(const Seeds& seeds) {
    const std::string cookie(32, '0');
    for (const char* path : {"/", "/state", "/programme.jpg", "/rig.jpg", "/board"})
        seeds.write("web_request", fmt::format("get{}", std::string_view(path).substr(1)),
                    fmt::format("LGET\n{}\nlocalhost:8443\n{}\nrig\nleft\n", path, cookie));
    seeds.write("web_request", "command", "LPOST!\n/command\n127.0.0.1\n\n\n\nshot 3");
    seeds.write("web_request", "login", "LPOST!\n/login\n[::1]:1\n\n\n\n1234");
    seeds.write("web_request", "bytes",
                "CPOST /command?a=%41&b HTTP/1.1\r\nHost: localhost\r\nX-Vantage: 1\r\nCookie: "
                "vantage=00; other=\"a b\"\r\nContent-Length: 4\r\n\r\nlive");
    seeds.write("web_request", "chunks",
                "CPOST /login HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: "
                "chunked\r\n\r\n4\r\n1234\r\n0\r\n\r\nGET /state HTTP/1.1\r\nHost: [::1]\r\n\r\n");
}

/// As ltc_fuzz.cpp has its sound.
void write_time_code(const Seeds& seeds) {
    LtcWriter writer(25);
    std::vector<std::int16_t> samples;
    for (const char* code : {"01:02:03:04", "01:02:03:05", "01:02:03:06"})
        for (const float sample : writer.frame(SmpteCode::parse(code).value()))
            samples.push_back(static_cast<std::int16_t>(sample * 32767));
    seeds.write("ltc", "three_frames", std::as_bytes(std::span(samples)));
}

void write_wheels(const Seeds& seeds) {
    using namespace std::string_view_literals;
    seeds.write("jog_report", "contour", "\5\0\5\0\0\0\5\7\6\0\x10\1"sv);
    seeds.write("jog_report", "speed_editor",
                "\7\3\0\0\2\0\0\xff\x0d\4\x33\0\x1c\0\0\0\0\0\0\0\0\0"sv);
    seeds.write("jog_report", "spacemouse", "\7\1\xaf\0\xa2\xfe\0\0\2\3\2"sv);
    seeds.write("wheel_profile", "all", R"(version = 1
name = "w"
devices = ["1209:b0b0"]
[[report]]
name = "jog"
kind = "counter"
report_id = 1
byte = 3
bit = 0
bits = 8
[[report]]
name = "ring"
kind = "axis"
report_id = 1
byte = 4
signed = true
centre = 0
full_scale = 127
[[report]]
name = "b"
kind = "buttons"
byte = 1
bits = 16
[axes.jog]
action = "wheel"
sensitivity = 1.0
inverted = false
[axes.ring]
action = "shuttle"
dead_zone = 0.1
curve = 1.5
[buttons]
b1 = "shot 1"
)");
    seeds.write("wheel_profile", "known",
                "version = 1\nname = \"w\"\ndevices = [\"0b33:0020\"]\n"
                "[axes.jog]\naction = \"orbit\"\n[buttons]\nb5 = \"mode\"\n");
}

void write_calibration(const Seeds& seeds) {
    CameraModel camera;
    camera.width_px = 320;
    camera.height_px = 240;
    camera.fx_px = camera.fy_px = 300;
    camera.cx_px = 160;
    camera.cy_px = 120;
    camera.distortion = {0.1, -0.2, 0, 0, 0.01};
    StereoCalibration calibration;
    calibration.left = calibration.right = camera;
    calibration.right_from_left.translation().x() = -0.12;
    compute_rectification(calibration, 0);
    // The first byte chooses the name, and a form that has several files is read one by one.
    for (const CalibrationForm& form : calibration_forms()) {
        if (!form.write) continue;
        for (const FormText& text : form.write(calibration)) {
            const char name = text.name == "cameras.txt" ? 2 : text.name == "images.txt" ? 3 : 0;
            seeds.write("calibration_form", form.name + "-" + text.name, name + text.text);
        }
    }
    save_calibration(seeds.place("calibration_file", "good.yaml"), calibration,
                     {"2026-01-01", "seed", 0.2, 0.1, 12});
}

/// As kept_frame_fuzz takes it apart.
void write_kept_frame(const Seeds& seeds) {
    RigFrame frame = seed_frame();
    const PackedFrame packed = FrameEncoder(85).encode(frame);
    KeptFrame kept{take_rig_of(decode_frame_head(packed.header)), 25, 37, {}};
    kept.frame = FrameStorer(kept.rig).store(packed);
    kept.frame.colour = kept.frame.depth = {std::byte{1}};
    kept.frame.record.colour_crc = kept.frame.record.depth_crc = crc32(kept.frame.colour);
    const KeptParts parts = encode(kept);
    const std::string record(reinterpret_cast<const char*>(parts.record.data()),
                             parts.record.size());
    std::string input{static_cast<char>(parts.head.size() & 0xff),
                      static_cast<char>(parts.head.size() >> 8)};
    input.append(reinterpret_cast<const char*>(parts.head.data()), parts.head.size());
    input += record.substr(0, record.rfind(",\"crc32\":\""));
    seeds.write("kept_frame", "whole", input);
}

void write_takes(const Seeds& seeds) {
    for (const int quality : {0, 85}) {
        RigFrame frame = seed_frame();
        TakeFacts facts;
        facts.program = "seed";
        facts.origin = tai_from_ns(0);
        facts.has_sound = quality > 0;
        PackedFrame packed = FrameEncoder(quality).encode(frame);
        facts.rigs = {take_rig_of(decode_frame_head(packed.header))};
        const std::filesystem::path path =
            seeds.place("take", "whole-" + std::to_string(quality) + ".mkv");
        std::filesystem::remove(path);
        TakeWriter writer(path, facts);
        FrameStorer storer(facts.rigs[0]);
        for (int i = 0; i < 3; ++i) {
            writer.add(0, storer.store(packed));
            ++frame.trigger_index;
            packed = FrameEncoder(quality).encode(frame);
        }
        CameraRecord camera;
        camera.time = tai_from_ns(1'000'000);
        writer.add(camera);
        const SoundBlock sound{480, std::vector<float>(960, 0.1F)};
        if (facts.has_sound) writer.add(sound);
        writer.finish();
        const auto unsealed = [](const std::string& text) {
            return text.substr(0, text.rfind(",\"crc32\""));
        };
        StoredFrame stored = storer.store(packed);
        seeds.write("take", "depth-" + std::to_string(quality), stored.depth);
        seeds.write("take", "record-" + std::to_string(quality), unsealed(to_text(stored.record)));
        seeds.write("take", "camera-" + std::to_string(quality), unsealed(to_text(camera)));
        seeds.write("take", "sound-" + std::to_string(quality),
                    unsealed(to_text(SoundRecord{480, 480, 1})));
        seeds.write("take", "facts-" + std::to_string(quality), to_json(facts).dump());
    }
}

void write_frame_sets(const Seeds& seeds) {
    const RigBackground rig{"rig-a", "fnv1a64:0123456789abcdef",
                            ColourImage(3, 4, cv::Vec4b(9, 8, 7, 6)), DepthImage(3, 4, 2.5f),
                            cv::Mat1b(3, 4, uchar{200})};
    seeds.write("background", "one", encode_background({tai_from_ns(1), {rig}}));
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: make_seeds FOLDER\n";
        return 2;
    }
    try {
        const vantage::Seeds seeds(argv[1]);
        vantage::write_frames(seeds);
        vantage::write_pictures(seeds);
        vantage::write_messages(seeds);
        vantage::write_pairing(seeds);
        vantage::write_configurations(seeds);
        vantage::write_controls(seeds);
        vantage::write_time_code(seeds);
        vantage::write_opentrackio(seeds);
        vantage::write_web_requests(seeds);
        vantage::write_wheels(seeds);
        vantage::write_calibration(seeds);
        vantage::write_takes(seeds);
        vantage::write_kept_frame(seeds);
        vantage::write_frame_sets(seeds);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "make_seeds: " << error.what() << '\n';
        return 1;
    }
}
