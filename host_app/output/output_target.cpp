#include "host_app/output/output_target.h"

#include "common/base/error.h"

namespace vantage {

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
