#include "host_app/commands/demo/demo_stage.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstring>
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

}  // namespace vantage
