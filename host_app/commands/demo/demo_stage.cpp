#include "host_app/commands/demo/demo_stage.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/base/files/unique_fd.h"
#include "common/base/log.h"
#include "common/wire/curve_keys.h"

namespace vantage {
namespace {

/// Returns a TCP port of the loopback interface that is free now and not one of `taken`, on which
/// nobody listens yet.
int free_port(const std::set<int>& taken) {
    std::vector<UniqueFd> held;
    for (;;) {
        UniqueFd socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        auto* plain = reinterpret_cast<sockaddr*>(&address);
        if (!socket || ::bind(socket.get(), plain, size) != 0 ||
            ::getsockname(socket.get(), plain, &size) != 0)
            fail("cannot find a free port for a rig: {}", std::strerror(errno));
        const int port = ntohs(address.sin_port);
        if (!taken.contains(port)) return port;
        held.push_back(std::move(socket));
    }
}

}  // namespace

DemoSize gpu_demo_size(int rigs, const std::function<double(const DemoSize&)>& match_ms) {
    const DemoSize full;
    DemoSize middle;
    middle.picture = {1280, 720};
    middle.rig = {640, 480};
    middle.disparities = 64;
    DemoSize small = middle;
    small.rate_hz = 12.5;
    small.preset = "fast";
    for (const DemoSize& size : {full, middle})
        if (rigs * size.rate_hz * match_ms(size) <= matching_ms_a_second) return size;
    return small;
}

double software_rate_hz(int rigs, double match_ms) {
    // Matching time per second at which the host skips hardly any instant on two slow cores
    // (measured).
    constexpr double rigs_ms_a_second = 220;
    // The stage's loop of 24 s is a whole number of periods at multiples of 0.5 Hz.
    constexpr double step_hz = 0.5, min_hz = 2;
    const double rate_hz = rigs_ms_a_second / (rigs * match_ms);
    return std::clamp(std::floor(rate_hz / step_hz) * step_hz, min_hz,
                      software_demo_size().rate_hz);
}

DemoSize software_demo_size() {
    DemoSize size;
    size.rate_hz = 4.5;
    size.latency_budget_ms = 600;
    size.rate = "25";
    size.preset = "fast";
    size.picture = {480, 270};
    // Colour costs little beside matching, and the camera flies nearer than the rigs stand.
    size.rig = {400, 300};
    size.match_width_px = 320;
    size.disparities = 32;
    size.is_software = true;
    return size;
}

DemoStage::DemoStage(std::filesystem::path folder, std::filesystem::path kept)
    : folder_(std::move(folder)), kept_(std::move(kept)) {
    make_folder(folder_);
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        if (const auto kind = entry.path().extension(); kind == ".key" || kind == ".toml")
            std::filesystem::remove(entry.path());
    // Secret keys never leave this folder.
    const CurveKeys host = generate_curve_keys();
    write_key_file(folder_ / "host.key", host);
    write_text_atomically(folder_ / "authorized_hosts", host.public_key + '\n');
}

void DemoStage::add_rig(const std::string& name, toml::table parts) {
    const CurveKeys keys = generate_curve_keys();
    write_key_file(folder_ / (name + ".key"), keys);
    const int port = free_port(ports_);
    ports_.insert(port);
    const std::string endpoint = fmt::format("tcp://127.0.0.1:{}", port);
    parts.insert("version", 1);
    parts.insert("name", name);
    // The network is the loopback interface, so the JPEG quality can be high.
    parts.insert("stream", toml::table{{"bind", endpoint},
                                       {"jpeg_quality", 85},
                                       {"chroma", "4:4:4"},
                                       {"key_file", name + ".key"},
                                       {"authorized_hosts", "authorized_hosts"}});
    if (!kept_.empty()) parts.insert("keep", toml::table{{"folder", kept_.string()}});
    write(name + ".toml", parts);
    rigs_.push_back(
        toml::table{{"name", name}, {"endpoint", endpoint}, {"public_key", keys.public_key}});
    names_.push_back(name);
}

void DemoStage::write(const std::string& name, const toml::table& table) const {
    std::ostringstream text;
    text << table << '\n';
    write_text_atomically(folder_ / name, text.str());
}

void DemoStage::write(const DemoSize& size) const {
    write("stage.toml", toml::table{{"version", 1},
                                    {"rate_hz", size.rate_hz},
                                    {"key_file", "host.key"},
                                    {"latency_budget_ms", size.latency_budget_ms},
                                    {"view", toml::table{{"width_px", size.picture[0]},
                                                         {"height_px", size.picture[1]}}},
                                    {"rigs", rigs_}});
}

std::string demo_move(std::string_view name) {
    const auto moves = demo_moves();
    const auto found = std::find_if(moves.begin(), moves.end(),
                                    [&](const EmbeddedText& move) { return move.name == name; });
    assert(found != moves.end());
    return std::string(found->text);
}

namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// Without a calibration the cameras are assumed to see 30 degrees, and the baseline is chosen so
/// that the middle of the scene is 2 m away.
constexpr double assumed_view_deg = 30, assumed_depth_m = 2;
constexpr int assumed_disparities = 128;

std::string add_bare_pair(const FilmedPair& pair, const AskProgram& ask, DemoStage& stage,
                          const DemoSize& size) {
    const nlohmann::json matched =
        ask("vantage-rig",
            {"match", pair.left, pair.right, "--disparities", std::to_string(assumed_disparities),
             "-o", stage.folder() / "pair.pfm", "--json"});
    const double f_px =
        matched.at("width").get<double>() / 2 / std::tan(assumed_view_deg / 2 / degrees);
    constexpr double least_parallax_px = 0.5;
    const double disparity_px = matched.at("median_disparity_px").get<double>();
    if (!(disparity_px > least_parallax_px))
        fail(
            "{} and {} show no parallax: most of the scene is shifted by {:.2f} px between them, "
            "at "
            "most {} px; give the left and the right picture of a stereo pair",
            pair.left.string(), pair.right.string(), disparity_px, least_parallax_px);
    stage.add_rig(
        "pair",
        toml::table{{"source", source_of(pair, size.rate_hz)},
                    {"virtual_rig",
                     toml::table{{"elevation_deg", 0.0},
                                 {"distance_m", assumed_depth_m},
                                 {"field_of_view_deg", assumed_view_deg},
                                 {"baseline_m",
                                  assumed_depth_m *
                                      matched.at("median_disparity_px").get<double>() / f_px}}},
                    {"match", toml::table{{"disparities", assumed_disparities}}}});
    return demo_move("pair.toml");
}

/// The default search range: a quarter of the width, in steps of 32.
int usual_disparities(int width_px) { return std::clamp(32 * ((width_px / 4 + 31) / 32), 64, 256); }

/// Returns the rate that the matcher keeps up with in half of the GPU's time, or in a quarter of a
/// software renderer's, rounded to four digits.
double sustained_rate_hz(double gpu_ms, double own_hz, bool is_software) {
    const double max_hz = (is_software ? 0.5 : 1.0) * matching_ms_a_second / gpu_ms;
    const double rate_hz = std::clamp(max_hz, std::min(0.2, own_hz), own_hz);
    const double step = std::pow(10, std::floor(std::log10(rate_hz)) - 3);
    return std::round(rate_hz / step) * step;
}

/// Returns a flight in front of the rig. It stays within some baselines of it, since a single rig
/// sees its scene from one side only.
std::string move_before(const nlohmann::json& rectified, double median_disparity_px) {
    const auto number = [&](const char* key) { return rectified.at(key).get<double>(); };
    const auto eye = rectified.at("position_m").get<std::array<double, 3>>();
    const auto axis = rectified.at("looks_along").get<std::array<double, 3>>();
    const double depth_m =
        number("f_px") * number("baseline_m") / (median_disparity_px + number("doffs_px"));
    const double azimuth_deg = std::atan2(-axis[0], -axis[2]) * degrees;
    const double elevation_deg = std::atan2(-axis[1], std::hypot(axis[0], axis[2])) * degrees;
    const double aside_deg = std::min(4.0, std::atan2(3 * number("baseline_m"), depth_m) * degrees);
    const double nearer = std::min(0.15, 3 * number("baseline_m") / depth_m);
    toml::array keyframes;
    const auto add = [&](double time_s, double aside, double above, double near) {
        keyframes.push_back(toml::table{{"time_s", time_s},
                                        {"azimuth_deg", azimuth_deg + aside},
                                        {"elevation_deg", elevation_deg + above},
                                        {"distance_m", near * depth_m}});
    };
    add(0, 0, 0, 1);
    add(3, aside_deg, aside_deg / 4, 1 - nearer / 2);
    add(6, 0, aside_deg / 2, 1 - nearer);
    add(9, -aside_deg, aside_deg / 4, 1 - nearer / 2);
    add(12, 0, 0, 1);
    toml::table& first = *keyframes[0].as_table();
    first.insert("pivot_m", toml::array{eye[0] + depth_m * axis[0], eye[1] + depth_m * axis[1],
                                        eye[2] + depth_m * axis[2]});
    first.insert("field_of_view_deg",
                 2 * std::atan2(number("width") / 2, number("f_px")) * degrees);
    std::ostringstream text;
    text << toml::table{{"version", 1}, {"loop", false}, {"keyframe", keyframes}};
    return text.str();
}

}  // namespace

toml::table source_of(const FilmedPair& pair, double rate_hz) {
    toml::table source{{"kind", "files"}, {"rate_hz", rate_hz}, {"left", pair.left.string()}};
    if (pair.right != "-")
        source.insert("right", pair.right.string());
    else
        source.insert("side_by_side", true);
    return source;
}

std::string add_filmed_rig(const FilmedPair& pair, const AskProgram& ask, DemoStage& stage,
                           DemoSize& size) {
    if (pair.calibration.empty()) return add_bare_pair(pair, ask, stage, size);
    constexpr double usual_hz = 30;
    const std::filesystem::path first = stage.folder() / "first";
    std::filesystem::remove_all(first);
    const std::filesystem::path look = stage.rig_file("look");
    stage.write(
        "look.toml",
        toml::table{{"version", 1}, {"name", "pair"}, {"source", source_of(pair, usual_hz)}});
    const nlohmann::json seen = ask("vantage-rig", {"capture", "--config", look, "--every", "1",
                                                    "--count", "1", "-o", first, "--json"});
    std::filesystem::remove(look);
    std::filesystem::path sides[2];
    for (const auto& entry : std::filesystem::directory_iterator(first))
        sides[entry.path().filename().string().starts_with("right_")] = entry.path();
    const std::filesystem::path left = first / "left.png", right = first / "right.png";
    const nlohmann::json rectified =
        ask("vantage-calib", {"rectify", "--calibration", pair.calibration, sides[0], sides[1],
                              "--out-left", left, "--out-right", right, "--json"});
    size.disparities =
        pair.disparities.value_or(usual_disparities(rectified.at("width").get<int>()));
    const nlohmann::json matched =
        ask("vantage-rig",
            {"match", left, right, "--disparities", std::to_string(size.disparities), "--preset",
             size.preset, "--repeats", "3", "-o", first / "disparity.pfm", "--json"});
    const auto own_hz = seen.value("material_rate_hz", nlohmann::json());
    size.rate_hz = pair.rate_hz.value_or(
        sustained_rate_hz(matched.at("gpu_ms").get<double>(),
                          own_hz.is_number() ? own_hz.get<double>() : usual_hz, size.is_software));
    size.latency_budget_ms = size.rate_hz < 15 ? static_cast<int>(3000 / size.rate_hz) : 200;
    stage.add_rig("pair", toml::table{{"calibration", pair.calibration.string()},
                                      {"source", source_of(pair, size.rate_hz)},
                                      {"match", toml::table{{"preset", size.preset},
                                                            {"disparities", size.disparities}}}});
    log_info("matching {} disparities, playing at {:.4g} Hz{}", size.disparities, size.rate_hz,
             own_hz.is_number() ? fmt::format(" (the material has {:.4g} Hz)", own_hz.get<double>())
                                : std::string());
    return move_before(rectified, matched.at("median_disparity_px").get<double>());
}

}  // namespace vantage
