#include "host_app/takes/kept_fetch.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/take/take_pulses.h"
#include "common/wire/zmq_helpers.h"
#include "host_app/takes/take_show.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds progress_period{2};
/// The longest wait between two checks of `is_stopped`.
constexpr std::chrono::milliseconds longest_wait{100};

}  // namespace

std::vector<FetchStats> KeptFetch::run(const StageConfig& stage,
                                       const std::function<bool()>& is_stopped,
                                       const Progress& progress) const {
    for (const std::string& name : rigs)
        if (std::none_of(stage.rigs.begin(), stage.rigs.end(),
                         [&](const StageConfig::Rig& rig) { return rig.name == name; }))
            fail("the stage has no rig named {}", name);
    std::optional<CurveKeys> keys;
    if (!stage.key_file.empty()) keys = load_key_file(stage.key_file);
    const nlohmann::ordered_json show = to_json(take_show_of(stage));
    zmq::context_t context;
    std::vector<std::unique_ptr<RigFetch>> fetches;
    for (const StageConfig::Rig& rig : stage.rigs) {
        if (!rigs.empty() && std::find(rigs.begin(), rigs.end(), rig.name) == rigs.end()) continue;
        FetchedFiles files(folder, rig.name, show);
        std::vector<std::uint64_t> there = files.there();
        if (take) {
            const std::vector<std::uint64_t> in_take = pulses_of_rig(*take, rig.name);
            there.insert(there.end(), in_take.begin(), in_take.end());
            std::sort(there.begin(), there.end());
        }
        fetches.push_back(std::make_unique<RigFetch>(
            context, rig, keys, stage.rate_hz,
            [this, there = std::move(there)](int tai_offset_s) {
                return missing_parts(range(tai_offset_s), there);
            },
            std::move(files), patience));
    }

    const auto stats = [&] {
        std::vector<FetchStats> all;
        for (const auto& fetch : fetches) all.push_back(fetch->stats());
        return all;
    };
    const auto is_done = [](const auto& fetch) { return fetch->stats().is_done; };
    BandwidthBudget budget(bytes_s);
    MonotonicTime next_progress = MonotonicClock::now() + progress_period;
    for (std::size_t turn = 0;
         !std::all_of(fetches.begin(), fetches.end(), is_done) && !is_stopped(); ++turn) {
        const MonotonicTime now = MonotonicClock::now();
        // Round robin: each rig in turn is the first to use the budget.
        for (std::size_t i = 0; i < fetches.size(); ++i)
            fetches[(turn + i) % fetches.size()]->turn(budget, now);
        if (now >= next_progress) {
            next_progress = now + progress_period;
            progress(stats());
        }
        std::vector<zmq::pollitem_t> items;
        for (const auto& fetch : fetches) {
            items.push_back({fetch->link().socket().handle(), 0, ZMQ_POLLIN, 0});
            items.push_back({fetch->link().monitor().handle(), 0, ZMQ_POLLIN, 0});
        }
        const std::chrono::nanoseconds wait = budget.wait(MonotonicClock::now());
        wait_for(items, wait.count() > 0 ? std::min<std::chrono::nanoseconds>(wait, longest_wait)
                                         : longest_wait);
    }
    for (const auto& fetch : fetches) fetch->finish();
    return stats();
}

}  // namespace vantage
