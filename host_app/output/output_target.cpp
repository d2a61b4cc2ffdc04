#include "host_app/output/output_target.h"

#include <cassert>

#include "common/base/error.h"

namespace vantage {

void OutputTarget::write(const ColourImage&, std::int64_t, const std::string&) {
    assert(!"a target of frames that are not encoded overrides write()");
}

void OutputTarget::write_encoded(const EncodedPicture&, std::int64_t) {
    assert(!"a target of encoded frames overrides write_encoded()");
}

OutputPlan plan_output(const std::string& text, const OutputFormat& format) {
    OutputUrl url = OutputUrl::parse(text);
    // An option of every kind of output.
    const bool begins = url.choice("start", {"on", "off"}) == "on";
    url.options.erase("start");
    std::string known;
    for (const OutputEntry& entry : output_entries()) {
        if (entry.scheme == url.scheme) {
            OutputPlan plan = entry.plan(url, format);
            plan.begins = begins;
            return plan;
        }
        known += (known.empty() ? "" : ", ") + entry.words;
    }
    fail("there is no output {}: outputs are {}", url.shown, known);
}

}  // namespace vantage
