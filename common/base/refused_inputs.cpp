#include "common/base/refused_inputs.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>

#include "common/base/log.h"
#include "common/base/log_limiter.h"

namespace vantage {
namespace {

struct RefusedEntry {
    RefusedInput last;
    LogLimiter limiter{std::chrono::minutes(1)};
};

struct RefusedRegister {
    std::mutex mutex;
    std::map<std::string, RefusedEntry, std::less<>> entries;
};

/// Never destroyed, since threads refuse inputs to the end.
RefusedRegister& refused_register() {
    static auto* const all = new RefusedRegister;
    return *all;
}

std::string hex_of(std::span<const std::byte> bytes) {
    std::string hex;
    for (const std::byte byte : bytes)
        hex += fmt::format("{:02x}", std::to_integer<unsigned>(byte));
    return hex;
}

}  // namespace

void note_refused_input(std::string_view decoder, std::span<const std::byte> input,
                        std::string_view reason) {
    RefusedRegister& all = refused_register();
    std::optional<RefusedInput> logged;
    {
        const std::lock_guard lock(all.mutex);
        RefusedEntry& entry = all.entries[std::string(decoder)];
        entry.last = {std::string(decoder), std::string(reason),
                      hex_of(input.first(std::min(input.size(), max_refused_bytes))), input.size(),
                      entry.last.count + 1};
        if (entry.limiter.count(1, MonotonicClock::now())) logged = entry.last;
    }
    if (logged)
        log_info("refused input of {} ({}), {} bytes: {}{}", logged->decoder, logged->reason,
                 logged->bytes, logged->hex, logged->bytes > max_refused_bytes ? "..." : "");
}

std::vector<RefusedInput> refused_inputs() {
    RefusedRegister& all = refused_register();
    const std::lock_guard lock(all.mutex);
    std::vector<RefusedInput> inputs;
    for (const auto& [decoder, entry] : all.entries) inputs.push_back(entry.last);
    return inputs;
}

}  // namespace vantage
