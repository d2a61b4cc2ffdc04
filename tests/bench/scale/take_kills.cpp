// What a take is worth whose recorder was killed: a process records four rigs at 25 Hz, with gaps
// put in on purpose, and is ended by kill -9 after a random time; the take is then held against
// what was sent.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <iostream>
#include <map>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/percentiles.h"
#include "common/base/time/pulse_grid.h"
#include "common/take/take_check.h"
#include "common/take/take_recorder.h"
#include "tests/bench/support/markdown_tables.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

constexpr double rate_hz = 25;
constexpr std::uint64_t first_pulse = 44'000'000'000;
const std::vector<std::string> rigs{"west", "north", "east", "south"};

/// What of a rig is never sent, so that there is something to be named.
bool is_left_out(std::uint64_t seed, std::size_t rig, std::uint64_t pulse) {
    cv::RNG random(seed * 1'000'003 + rig * 7919 + pulse);
    random.next();
    return pulse > first_pulse && random.uniform(0, 20) == 0;
}

constexpr std::uint64_t most_pulses = 4096;

/// What the killed process leaves to its parent.
struct Sent {
    struct Frame {
        std::uint32_t header_crc = 0, colour_crc = 0;
    };
    std::atomic<std::uint64_t> newest[4]{};  ///< pulses; 0: none yet
    Frame frames[4][most_pulses]{};
};

RigFrame filmed_frame(std::size_t rig, std::uint64_t pulse) {
    RigFrame frame = make_frame(pulse * rigs.size() + rig, 160, 120);
    frame.rig = rigs[rig];
    frame.trigger_index = pulse;
    frame.exposure = PulseGrid(rate_hz).time_of(pulse);
    return frame;
}

/// Never returns.
[[noreturn]] void record(const std::filesystem::path& path, std::uint64_t seed, Sent& sent) {
    TakeRecorder::Settings settings;
    settings.rigs = rigs;
    settings.pulse_rate_hz = rate_hz;
    settings.program = "take_kills";
    settings.disk_mb_s = [](const std::filesystem::path&) { return 1000.0; };
    TakeRecorder recorder(settings);
    recorder.begin(path);
    FrameEncoder encoder(85);
    const MonotonicTime begun = MonotonicClock::now();
    for (std::uint64_t pulse = first_pulse; pulse < first_pulse + most_pulses; ++pulse) {
        std::this_thread::sleep_until(
            begun + std::chrono::duration_cast<std::chrono::nanoseconds>(
                        std::chrono::duration<double>((pulse - first_pulse) / rate_hz)));
        for (std::size_t rig = 0; rig < rigs.size(); ++rig) {
            if (is_left_out(seed, rig, pulse)) continue;
            ArrivedFrame frame;
            frame.rig = rig;
            RigFrame filmed = filmed_frame(rig, pulse);
            const PackedFrame packed = encoder.encode(filmed);
            sent.frames[rig][pulse - first_pulse] = {crc32(packed.header), crc32(packed.colour)};
            frame.packed = std::make_shared<const PackedFrame>(packed);
            frame.arrival = MonotonicClock::now();
            frame.arrival_tai = TaiClock::now();
            recorder.offer(frame);
            sent.newest[rig] = pulse;
        }
    }
    _exit(1);
}

struct Tally {
    int kills = 0;
    int before_head = 0;  ///< killed before there was a file
    int opened = 0, by_ffprobe = 0;
    int check_right = 0;
    int cut_block = 0;  ///< that end within a block
    std::uint64_t frames = 0, gaps = 0;
    PercentileRecorder lost_ms{100'000};
    std::vector<std::string> wrong;
};

using Gaps = std::vector<std::tuple<std::string, std::uint64_t, std::uint64_t>>;

/// What check has to name in such a take.
Gaps expected_gaps(std::uint64_t seed, const TakeReader& take) {
    std::uint64_t first = ~std::uint64_t{0}, last = 0;
    for (std::size_t rig = 0; rig < rigs.size(); ++rig) {
        if (take.frames(rig).empty()) continue;
        first = std::min(first, take.frames(rig).front().pulse);
        last = std::max(last, take.frames(rig).back().pulse);
    }
    Gaps gaps;
    if (last == 0) return gaps;
    for (std::size_t rig = 0; rig < rigs.size(); ++rig) {
        if (take.frames(rig).empty()) {
            gaps.emplace_back(rigs[rig], first, last);
            continue;
        }
        std::uint64_t from = 0;
        for (std::uint64_t pulse = first_pulse; pulse <= take.frames(rig).back().pulse; ++pulse) {
            const bool is_missing = is_left_out(seed, rig, pulse);
            if (is_missing && from == 0) from = pulse;
            if (!is_missing && from != 0)
                gaps.emplace_back(rigs[rig], std::exchange(from, 0), pulse - 1);
        }
    }
    std::sort(gaps.begin(), gaps.end());
    return gaps;
}

/// Empty: the take is right, and the check of it.
std::string fault_of(const TakeReader& take, std::uint64_t seed, const Sent& sent, Tally& tally) {
    const TakeVerdict verdict = check_take(take);
    Gaps named;
    for (const TakeGap& gap : verdict.gaps) named.emplace_back(gap.rig, gap.from, gap.to);
    std::sort(named.begin(), named.end());
    if (named != expected_gaps(seed, take)) return "check names other gaps than were made";
    tally.gaps += named.size();
    for (const TakeDamage& damage : verdict.damage)
        if (damage.words.find("are truncated") == std::string::npos) return damage.words;
    tally.cut_block += !verdict.damage.empty();
    std::uint64_t frames = 0;
    for (std::size_t rig = 0; rig < rigs.size(); ++rig) {
        FrameRestorer restorer(take.facts().rigs[rig]);
        for (const TakeReader::Frame& frame : take.frames(rig)) {
            const StoredFrame stored = take.load(rig, frame);
            const Sent::Frame& then = sent.frames[rig][frame.pulse - first_pulse];
            if (crc32(stored.colour) != then.colour_crc ||
                crc32(stored.record.header) != then.header_crc ||
                !same_pixels(restorer.restore(stored).disparity,
                             filmed_frame(rig, frame.pulse).disparity))
                return fmt::format("pulse {} of {} is not what was sent", frame.pulse, rigs[rig]);
            ++frames;
        }
    }
    if (frames != verdict.frames) return "check counts other frames than there are";
    tally.frames += frames;
    return "";
}

void look_at(const std::filesystem::path& path, std::uint64_t seed, const Sent& sent,
             Tally& tally) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        ++tally.before_head;
        return;
    }
    try {
        const TakeReader take(path);
        ++tally.opened;
        if (run_to_end("/usr/bin/env", {"ffprobe", "-v", "quiet", "-show_streams", path.string()})
                .status == 0)
            ++tally.by_ffprobe;
        const std::string fault = fault_of(take, seed, sent, tally);
        tally.check_right += fault.empty();
        if (!fault.empty()) tally.wrong.push_back(fmt::format("{}: {}", seed, fault));
        for (std::size_t rig = 0; rig < rigs.size(); ++rig) {
            if (sent.newest[rig] == 0) continue;
            const std::uint64_t kept =
                take.frames(rig).empty() ? first_pulse - 1 : take.frames(rig).back().pulse;
            // What was killed between handing a frame over and noting that has kept one more.
            const std::uint64_t lost = sent.newest[rig] > kept ? sent.newest[rig] - kept : 0;
            tally.lost_ms.add(static_cast<double>(lost) * 1000 / rate_hz);
        }
    } catch (const Error& error) {
        tally.wrong.push_back(fmt::format("{}: {}", seed, error.what()));
    }
}

std::string table_of(const Tally& tally) {
    const Percentiles lost = tally.lost_ms.summary();
    return fmt::format(
        "| kills | before there was a file | files that open | files that `ffprobe` opens | "
        "`check` right | end within a block | frames compared | gaps named | lost: median | 95 % | "
        "most |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n"
        "| {} | {} | {} | {} | {} | {} | {} | {} | {:.0f} ms | {:.0f} ms | {:.0f} ms |\n",
        tally.kills, tally.before_head, tally.opened, tally.by_ffprobe, tally.check_right,
        tally.cut_block, tally.frames, tally.gaps, lost.p50, lost.p95, lost.max);
}

int run(int argc, char** argv) {
    CLI::App app{"Kills what records a take at random times, and looks at every take"};
    int kills = 200;
    std::uint64_t seed = 1;
    double longest_s = 2.5;
    std::string document;
    app.add_option("--kills", kills)->check(CLI::Range(1, 100'000))->capture_default_str();
    app.add_option("--seed", seed, "Of the times and the gaps")->capture_default_str();
    app.add_option("--longest", longest_s, "A recording, seconds")
        ->check(CLI::Range(0.1, 120.0))
        ->capture_default_str();
    app.add_option("--write", document, "Markdown file whose table is written anew");
    CLI11_PARSE(app, argc, argv);
    const TemporaryFolder folder;
    void* memory =
        mmap(nullptr, sizeof(Sent), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) fail("memory is short");
    cv::RNG random(seed);
    Tally tally;
    for (; tally.kills < kills; ++tally.kills) {
        const std::filesystem::path path = folder.path() / fmt::format("{}.mkv", tally.kills);
        const std::uint64_t own_seed = seed * 100'000 + static_cast<std::uint64_t>(tally.kills);
        Sent& sent = *new (memory) Sent;
        const pid_t child = fork();
        if (child < 0) fail("no process can be made");
        if (child == 0) record(path, own_seed, sent);
        usleep(static_cast<useconds_t>(random.uniform(0.0, longest_s) * 1e6));
        kill(child, SIGKILL);
        int status = 0;
        waitpid(child, &status, 0);
        if (!WIFSIGNALED(status)) fail("what records ended by itself with {}", status);
        look_at(path, own_seed, sent, tally);
        std::filesystem::remove(path);
    }
    std::cout << table_of(tally);
    for (const std::string& wrong : tally.wrong) std::cerr << wrong << '\n';
    if (!document.empty()) put_between_markers(document, table_of(tally));
    return tally.wrong.empty() && tally.lost_ms.summary().max <= 1000 ? 0 : 1;
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    try {
        return vantage::run(argc, argv);
    } catch (const vantage::Error& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
