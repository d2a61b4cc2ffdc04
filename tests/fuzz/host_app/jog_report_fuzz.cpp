#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <set>
#include <string>

#include "host_app/control/hid/jog_family.h"
#include "host_app/control/hid/wheel_profile.h"

namespace {

using namespace vantage;

/// A kind of device, and the names its events may have.
struct Candidate {
    std::function<std::unique_ptr<JogDecoder>()> make;
    std::set<std::string> controls;
};

std::vector<Candidate> make_candidates() {
    std::vector<Candidate> candidates;
    const auto add = [&](std::function<std::unique_ptr<JogDecoder>()> make) {
        std::set<std::string> names;
        for (const JogControl& control : make()->controls()) names.insert(control.name);
        candidates.push_back({std::move(make), std::move(names)});
    };
    for (const JogFamily& family : jog_families())
        add([family] { return family.make_decoder(family.models.front().id); });
    // The larger of its family.
    add([] { return make_known_decoder({0x05f3, 0x045a}); });
    using Kind = ReportField::Kind;
    std::vector<ReportField> fields(4);
    fields[0] = {
        .kind = Kind::counter, .name = "jog", .report_id = 1, .byte = 1, .bit = 3, .bits = 13};
    fields[1] = {
        .kind = Kind::axis, .name = "ring", .report_id = 1, .byte = 2, .bit = 7, .bits = 32};
    fields[2] = {.kind = Kind::buttons, .name = "b", .report_id = 2, .byte = 60, .bits = 32};
    fields[3] = {.kind = Kind::delta, .name = "d", .report_id = {}, .byte = 0, .bits = 1};
    add([fields] { return make_described_decoder(fields); });
    return candidates;
}

}  // namespace

/// The input is a row of reports: a byte for the length, then so many bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::vector<Candidate> candidates = make_candidates();
    for (const Candidate& candidate : candidates) {
        // Fresh, so that a report meets only what those of this input left behind.
        const std::unique_ptr<JogDecoder> decoder = candidate.make();
        for (std::size_t at = 0; at < size;) {
            const std::size_t length = std::min<std::size_t>(data[at], size - at - 1);
            std::vector<JogEvent> events;
            const bool taken = decoder->decode({data + at + 1, length}, events);
            if (!taken && !events.empty()) std::abort();
            for (const JogEvent& event : events) {
                if (!candidate.controls.contains(event.control) || !std::isfinite(event.value))
                    std::abort();
                if (event.kind == JogKind::axis && std::abs(event.value) > 1) std::abort();
            }
            at += 1 + length;
        }
    }
    return 0;
}
