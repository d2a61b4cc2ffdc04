// Measures a rig's stream over TCP and over SRT on links with loss and long round trips: the share
// of frames that arrive, their latency, and the bytes on the link. Rig and host are Vantage's own
// publisher and receiver. Writes the table of docs/results/faults.md.
#include <chrono>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/receive/stage_receiver.h"
#include "rig_firmware/stream/publisher.h"
#include "tests/bench/support/markdown_tables.h"
#include "tests/faults/impaired_road.h"
#include "tests/support/data_folder.h"
#include "tests/support/keyed_stream.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr auto frame_period = 40ms;
constexpr double latency_budget_ms = 200;
/// The wait for frames that are under way at the end of a measurement.
constexpr auto under_way = 400ms;

struct Result {
    std::uint64_t filmed = 0, came = 0;
    double p50_ms = 0, p99_ms = 0;
    double mbit_per_s = 0;  ///< on the road, both ways
    std::size_t frame_bytes = 0;
};

/// Calls `publish` with the number of each frame at the rate of the stage for so long, and waits
/// for what is under way then. Returns how many there were.
std::uint64_t film(double seconds, const std::function<void(std::uint64_t)>& publish) {
    std::uint64_t filmed = 0;
    const auto start = std::chrono::steady_clock::now();
    auto next = start;
    while (next - start < std::chrono::duration<double>(seconds)) {
        publish(filmed++);
        std::this_thread::sleep_until(next += frame_period);
    }
    std::this_thread::sleep_for(under_way);
    return filmed;
}

double mbit_per_s(const ImpairedRoad& road, std::uint64_t bytes_before, double seconds) {
    return 8e-6 * static_cast<double>(road.counts().bytes - bytes_before) / seconds;
}

/// Of this thread's network.
void use_congestion_control(const std::string& name) {
    if (name.empty()) return;
    std::ofstream setting("/proc/sys/net/ipv4/tcp_congestion_control");
    setting << name << std::flush;
    if (!setting)
        fail(
            "this kernel has no congestion control '{}', or "
            "net.ipv4.tcp_allowed_congestion_control "
            "does not list it",
            name);
}

/// How frames go.
struct Manner {
    std::string name;
    std::string road;     ///< of rig.toml
    std::string control;  ///< of TCP's congestion; empty: the computer's own
};

Result measure(const RoadTrouble& trouble, const Manner& manner, double seconds, cv::Size size) {
    ImpairedRoad road;
    use_congestion_control(manner.control);
    road.at_the_rigs([&] { use_congestion_control(manner.control); });
    const TemporaryFolder folder;
    RigConfig::Stream stream = keyed_stream(folder.path());
    stream.bind = "tcp://*:*";
    stream.road = manner.road;
    std::unique_ptr<Publisher> rig;
    road.at_the_rigs([&] { rig = std::make_unique<Publisher>(stream, "far"); });
    StageConfig stage;
    stage.rate_hz = 25;
    stage.latency_budget_ms = latency_budget_ms;
    stage.key_file = folder.path() / "host.key";
    // "tcp://[::]:PORT"
    const std::string port = rig->endpoint().substr(rig->endpoint().rfind(':') + 1);
    stage.rigs.push_back(
        {"far", fmt::format("tcp://{}:{}", ImpairedRoad::rig_address, port), rig->public_key()});
    // As it is before they connect, since TCP and BBR remember the shortest round trip.
    road.impair(trouble);
    StageReceiver host(stage);
    RigSync sync;
    sync.rate_hz = stage.rate_hz;
    rig->report(sync);
    const bool is_srt = manner.road == "srt";
    while (!host.status().rigs[0].connected || host.status().rigs[0].by_datagrams != is_srt)
        std::this_thread::sleep_for(10ms);
    Result result;
    const RigFrame filmed = make_frame(0, size.width, size.height);
    const std::uint64_t bytes_before = road.counts().bytes;
    result.filmed = film(seconds, [&](std::uint64_t number) {
        RigFrame frame = filmed;
        frame.trigger_index = 1000 + number;
        frame.exposure = TaiClock::now();
        const auto packed = rig->publish(std::move(frame));
        result.frame_bytes =
            packed->header.size() + packed->colour.size() + packed->disparity.size();
        while (host.next(0s)) {
        }
    });
    result.mbit_per_s = mbit_per_s(road, bytes_before, seconds);
    while (host.next(0s)) {
    }
    const RigStatus status = host.status().rigs[0];
    result.came = status.received;
    result.p50_ms = status.latency_ms.p50;
    result.p99_ms = status.latency_ms.p99;
    return result;
}

void run(int argc, char** argv) {
    CLI::App app("What loss and distance do to a rig's stream");
    double seconds = 8;
    std::string document;
    std::string only;
    int width_px = 480;
    app.add_option("--seconds", seconds, "Of each measurement")->capture_default_str();
    app.add_option("--width", width_px, "Of the rig's pictures, 4:3")->capture_default_str();
    app.add_option("--only", only, "Roads whose name has this text");
    app.add_option("--write", document, "Document whose table is written anew");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::exit(app.exit(error));
    }
    if (const std::string reason = ImpairedRoad::reason_against(); !reason.empty())
        fail("{}", reason);
    std::ostringstream text;
    const cv::Size size(width_px, width_px * 3 / 4);
    const std::vector<int> round_trips_ms{1, 20, 100};
    std::size_t frame_bytes = 0;
    std::ostringstream rows;
    const std::vector<Manner> manners{
        {"TCP, cubic", "tcp", "cubic"}, {"TCP, bbr", "tcp", "bbr"}, {"SRT", "srt", ""}};
    for (const Manner& manner : manners) {
        if (manner.name.find(only) == std::string::npos) continue;
        for (const unsigned lose_every : {0u, 100u, 33u, 14u, 10u}) {
            rows << fmt::format("| {} | {:.0f} % |", manner.name,
                                lose_every == 0 ? 0.0 : 100.0 / lose_every);
            for (const int round_trip_ms : round_trips_ms) {
                RoadTrouble trouble;
                trouble.lose_every = lose_every;
                trouble.delay = std::chrono::microseconds(500 * round_trip_ms);
                const Result result = measure(trouble, manner, seconds, size);
                frame_bytes = result.frame_bytes;
                rows << fmt::format(
                    " {:.0f} %, {:.0f}, {:.0f}, {:.0f} |",
                    100.0 * static_cast<double>(result.came) / static_cast<double>(result.filmed),
                    result.p50_ms, result.p99_ms, result.mbit_per_s);
            }
            rows << "\n";
            std::cerr << manner.name << ", every " << lose_every << "\n";
        }
    }
    text << fmt::format(
        "One rig of {}x{}, 25 frames per second of {:.0f} kB ({:.0f} Mbit/s), {:g} s each. A cell "
        "has the share of frames that arrived, the median and the 99th percentile of the time "
        "from exposure to decoding in ms, and the Mbit/s on the road.\n\n"
        "| road | packets lost |",
        size.width, size.height, static_cast<double>(frame_bytes) / 1e3,
        8e-6 * 25 * static_cast<double>(frame_bytes), seconds);
    for (const int round_trip_ms : round_trips_ms)
        text << fmt::format(" round trip {} ms |", round_trip_ms);
    text << "\n| --- | --- |";
    for (std::size_t i = 0; i < round_trips_ms.size(); ++i) text << " --- |";
    text << "\n" << rows.str() << "\n";
    std::cout << text.str();
    if (!document.empty()) put_between_markers(document, text.str());
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    try {
        vantage::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "road_bench: " << error.what() << '\n';
        return 1;
    }
}
