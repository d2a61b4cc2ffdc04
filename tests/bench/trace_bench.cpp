// Prints the cost of a trace span: without a trace, and with one, in nanoseconds of one thread.

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "common/base/time/time.h"
#include "common/base/trace/trace.h"
#include "common/base/trace/trace_file.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

/// Median of several rounds. A round fits into a ring, and the file is written between two.
double ns_per_span() {
    constexpr int rounds = 101, spans = 2000;
    std::vector<double> ns;
    for (int round = 0; round < rounds; ++round) {
        const MonotonicTime start = MonotonicClock::now();
        for (int i = 0; i < spans; ++i)
            TraceSpan("span").with("number", i).in(TraceId::of_tick(1), TraceFlow::passes);
        ns.push_back(static_cast<double>((MonotonicClock::now() - start).count()) / spans);
        sleep_until(TaiClock::now() + std::chrono::milliseconds(5));
    }
    std::nth_element(ns.begin(), ns.begin() + rounds / 2, ns.end());
    return ns[rounds / 2];
}

void run() {
    const double before = ns_per_span();
    std::uint64_t dropped = 0;
    const TemporaryFolder folder;
    double with_trace = 0;
    {
        TraceFile::Limits limits;
        limits.period = std::chrono::milliseconds(1);
        const TraceFile trace(folder.path() / "trace.json", "trace_bench", false, limits);
        with_trace = ns_per_span();
        dropped = trace.dropped();
    }
    fmt::print("a span costs {:.1f} ns without a trace and {:.0f} ns with one; {} were dropped\n",
               before, with_trace, dropped);
}

}  // namespace
}  // namespace vantage

int main() { vantage::run(); }
