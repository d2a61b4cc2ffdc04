#include "tests/bench/scale/scale_rigs.h"

#include <chrono>
#include <memory>
#include <thread>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "common/config/stage_config.h"
#include "common/serve/frame_server.h"
#include "common/take/format/frame_storage.h"
#include "common/take/take_reader.h"
#include "common/wire/codec/disparity_codec.h"
#include "frame.pb.h"
#include "host_app/relay/rig_relay.h"
#include "tests/bench/support/cpu_time.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t session = 1;

std::string stage_text(const char* key_file, double rate_hz, const std::string& rigs) {
    return fmt::format("version = 1\nkey_file = \"{}\"\nrate_hz = {}\nlatency_budget_ms = 200\n{}",
                       key_file, rate_hz, rigs);
}

std::string entry(const std::string& name, const std::string& endpoint, const std::string& key) {
    return fmt::format("[[rigs]]\nname = \"{}\"\nendpoint = \"{}\"\npublic_key = \"{}\"\n", name,
                       endpoint, key);
}

std::shared_ptr<const PackedFrame> of_pulse(const PackedFrame& frame, const std::string& rig,
                                            std::uint64_t pulse, TaiTime exposure) {
    wire::FrameHeader header;
    if (!header.ParseFromArray(frame.header.data(), static_cast<int>(frame.header.size())))
        fail("a frame header of the take is damaged");
    header.set_rig(rig);
    header.set_session(session);
    header.set_synchronized(true);
    header.set_trigger_index(pulse);
    header.set_exposure_tai_ns(to_ns(exposure));
    header.set_published_tai_ns(to_ns(TaiClock::now()));
    auto sent = std::make_shared<PackedFrame>(frame);
    sent->trigger_index = pulse;
    sent->header.resize(header.ByteSizeLong());
    header.SerializeToArray(sent->header.data(), static_cast<int>(sent->header.size()));
    return sent;
}

struct Served {
    std::string name;
    std::unique_ptr<FrameServer> server;
    int streaming() const {
        return server->change([](const HostLinks& links) {
            int n = 0;
            for (const HostLinks::HostStatus& host : links.hosts()) n += host.streaming;
            return n;
        });
    }
};

}  // namespace

double cpu_s() { return cpu_ms() / 1e3; }

std::vector<std::vector<PackedFrame>> frames_of_take(const std::filesystem::path& path) {
    constexpr std::size_t most_frames = 8;
    const TakeReader take(path);
    std::vector<std::vector<PackedFrame>> all;
    for (std::size_t rig = 0; rig < take.facts().rigs.size(); ++rig) {
        std::vector<PackedFrame> frames;
        FrameRestorer restorer(take.facts().rigs[rig]);
        DisparityEncoder disparity;
        for (const TakeReader::Frame& frame : take.frames(rig)) {
            if (frames.size() == most_frames) break;
            const StoredFrame stored = take.load(rig, frame);
            PackedFrame& packed = frames.emplace_back();
            packed.header = stored.record.header;
            packed.colour = stored.colour;
            packed.disparity = disparity.encode(restorer.restore(stored).disparity);
        }
        if (!frames.empty()) all.push_back(std::move(frames));
    }
    if (all.empty()) fail("{} has no frames", path.string());
    return all;
}

void serve_scale_rigs(const ScaleFolder& folder, const ScaleRigs& wanted) {
    const std::vector<std::vector<PackedFrame>> filmed = frames_of_take(wanted.take);
    std::vector<Served> rigs;
    std::string entries;
    for (int i = 0; i < wanted.rigs; ++i) {
        FrameServer::Settings settings;
        settings.bind = "tcp://127.0.0.1:*";
        settings.key_file = folder.file("rig.key");
        settings.authorized_hosts = folder.file("rig.hosts");
        Served& rig = rigs.emplace_back(Served{fmt::format("rig{:02}", i), nullptr});
        rig.server = std::make_unique<FrameServer>(settings, rig.name, session);
        rig.server->change([](HostLinks& links) {
            RigSync sync;
            sync.role = RigSync::Role::lead;
            sync.ready = true;
            links.set_sync(sync);
        });
        entries += entry(rig.name, rig.server->endpoint(), rig.server->public_key());
    }
    write_text_atomically(folder.file("stage.toml"),
                          stage_text("host.key", wanted.rate_hz, entries));
    for (const Served& rig : rigs)
        while (rig.streaming() < wanted.hosts) std::this_thread::sleep_for(10ms);

    const PulseGrid grid(wanted.rate_hz);
    const double cpu_before_s = cpu_s();
    const auto begin = std::chrono::steady_clock::now();
    const auto pulses = static_cast<std::uint64_t>(wanted.seconds * wanted.rate_hz);
    const std::uint64_t first = grid.index_at_or_before(TaiClock::now()) + 1;
    double bytes = 0;
    for (std::uint64_t k = 0; k < pulses; ++k) {
        std::this_thread::sleep_until(begin + k * grid.period());
        for (std::size_t i = 0; i < rigs.size(); ++i) {
            const std::vector<PackedFrame>& own = filmed[i % filmed.size()];
            const auto frame =
                of_pulse(own[k % own.size()], rigs[i].name, first + k, grid.time_of(first + k));
            bytes += static_cast<double>(frame->bytes());
            rigs[i].server->tell([&](HostLinks& links) { links.offer(frame); });
        }
    }
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double used_s = cpu_s() - cpu_before_s;
    // What still waits goes, or is dropped.
    std::this_thread::sleep_for(1s);
    LinkCounters sum;
    for (const Served& rig : rigs)
        for (const HostLinks::HostStatus& host :
             rig.server->change([](const HostLinks& links) { return links.hosts(); })) {
            sum.offered += host.counters.offered;
            sum.sent += host.counters.sent;
            sum.send_dropped += host.counters.send_dropped;
        }
    const nlohmann::json stats{{"seconds", seconds},
                               {"frames", pulses * rigs.size()},
                               {"frame_bytes", bytes / static_cast<double>(pulses * rigs.size())},
                               {"offered", sum.offered},
                               {"sent", sum.sent},
                               {"send_dropped", sum.send_dropped},
                               {"cpu_s", used_s}};
    write_text_atomically(folder.file("rigs.json"), stats.dump());
    // Hosts look at what came before the links go.
    while (!std::filesystem::exists(folder.file("done"))) std::this_thread::sleep_for(20ms);
}

void serve_scale_relay(const ScaleFolder& folder) {
    const StageConfig stage = load_stage_config(folder.file("relay.toml"));
    const RigRelay relay(stage, {"tcp://127.0.0.1:*", folder.file("relay.hosts")});
    std::string entries;
    for (const RigRelay::Rig& rig : relay.status())
        entries += entry(rig.name, rig.endpoint, rig.public_key);
    write_text_atomically(folder.file("behind.toml"),
                          stage_text("host.key", stage.rate_hz, entries));
    const double before_s = cpu_s();
    while (!std::filesystem::exists(folder.file("rigs.json"))) std::this_thread::sleep_for(20ms);
    nlohmann::json stats{{"cpu_s", cpu_s() - before_s}};
    std::uint64_t frames = 0, sent = 0;
    double bytes = 0;
    for (const RigRelay::Rig& rig : relay.status()) {
        frames += rig.frames;
        bytes += static_cast<double>(rig.bytes);
        for (const HostLinks::HostStatus& host : rig.hosts) sent += host.counters.sent;
    }
    stats["frames"] = frames;
    stats["bytes"] = bytes;
    stats["sent"] = sent;
    write_text_atomically(folder.file("relay.json"), stats.dump());
    while (!std::filesystem::exists(folder.file("done"))) std::this_thread::sleep_for(20ms);
}

}  // namespace vantage
