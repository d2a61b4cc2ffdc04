// What loss and distance do to a rig's stream over TCP: how many frames come, and how late. Writes
// the table of docs/results/faults.md.
#include <chrono>
#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/receive/stage_receiver.h"
#include "common/wire/curve_keys.h"
#include "rig_firmware/stream/publisher.h"
#include "tests/bench/support/markdown_tables.h"
#include "tests/faults/impaired_road.h"
#include "tests/support/data_folder.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr auto frame_period = 40ms;
constexpr double latency_budget_ms = 200;

struct Result {
    std::uint64_t filmed = 0, came = 0;
    double p50_ms = 0, p99_ms = 0;
    std::size_t frame_bytes = 0;
};

/// Of this thread's network.
void use_congestion_control(const std::string& name) {
    std::ofstream setting("/proc/sys/net/ipv4/tcp_congestion_control");
    setting << name << std::flush;
    if (!setting)
        fail(
            "this kernel has no congestion control '{}', or "
            "net.ipv4.tcp_allowed_congestion_control "
            "does not list it",
            name);
}

Result measure(const RoadTrouble& trouble, const std::string& control, double seconds,
               cv::Size size) {
    ImpairedRoad road;
    use_congestion_control(control);
    road.at_the_rigs([&] { use_congestion_control(control); });
    const TemporaryFolder folder;
    const CurveKeys host_keys = generate_curve_keys();
    write_key_file(folder.path() / "host.key", host_keys);
    write_key_file(folder.path() / "rig.key", generate_curve_keys());
    std::ofstream(folder.path() / "hosts.keys") << host_keys.public_key << " the host\n";
    RigConfig::Stream stream;
    stream.bind = "tcp://*:5600";
    stream.key_file = folder.path() / "rig.key";
    stream.authorized_hosts = folder.path() / "hosts.keys";
    std::unique_ptr<Publisher> rig;
    road.at_the_rigs([&] { rig = std::make_unique<Publisher>(stream, "far"); });
    StageConfig stage;
    stage.rate_hz = 25;
    stage.latency_budget_ms = latency_budget_ms;
    stage.key_file = folder.path() / "host.key";
    stage.rigs.push_back(
        {"far", fmt::format("tcp://{}:5600", ImpairedRoad::rig_address), rig->public_key()});
    StageReceiver host(stage);
    while (!host.status().rigs[0].connected) std::this_thread::sleep_for(10ms);
    road.impair(trouble);
    Result result;
    const RigFrame filmed = make_frame(0, size.width, size.height);
    const auto start = std::chrono::steady_clock::now();
    auto next = start;
    while (next - start < std::chrono::duration<double>(seconds)) {
        RigFrame frame = filmed;
        frame.trigger_index = 1000 + result.filmed++;
        frame.exposure = TaiClock::now();
        const auto packed = rig->publish(std::move(frame));
        result.frame_bytes =
            packed->header.size() + packed->colour.size() + packed->disparity.size();
        while (host.next(0s)) {
        }
        std::this_thread::sleep_until(next += frame_period);
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
    int width_px = 480;
    app.add_option("--seconds", seconds, "Of each measurement")->capture_default_str();
    app.add_option("--width", width_px, "Of the rig's pictures, 4:3")->capture_default_str();
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
    for (const char* control : {"cubic", "bbr"})
        for (const unsigned lose_every : {0u, 100u, 33u, 14u, 10u}) {
            rows << fmt::format("| {} | {:.0f} % |", control,
                                lose_every == 0 ? 0.0 : 100.0 / lose_every);
            for (const int round_trip_ms : round_trips_ms) {
                RoadTrouble trouble;
                trouble.lose_every = lose_every;
                trouble.delay = std::chrono::microseconds(500 * round_trip_ms);
                const Result result = measure(trouble, control, seconds, size);
                frame_bytes = result.frame_bytes;
                rows << fmt::format(
                    " {:.0f} %, {:.0f}, {:.0f} |",
                    100.0 * static_cast<double>(result.came) / static_cast<double>(result.filmed),
                    result.p50_ms, result.p99_ms);
            }
            rows << "\n";
            std::cerr << control << ", every " << lose_every << "\n";
        }
    text << fmt::format(
        "One rig of {}x{}, 25 frames per second of {:.0f} kB ({:.0f} Mbit/s), {:g} s each. A cell "
        "has the share of frames that arrived, then the median and the 99th percentile of the time "
        "from exposure to decoding in ms.\n\n"
        "| congestion control | packets lost |",
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
