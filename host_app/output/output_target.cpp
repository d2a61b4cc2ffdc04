#include "host_app/output/output_target.h"

#include "common/base/error.h"

namespace vantage {

OutputPlan plan_output(const std::string& text, const OutputFormat& format) {
    const OutputUrl url = OutputUrl::parse(text);
    std::string known;
    for (const OutputEntry& entry : output_entries()) {
        if (entry.scheme == url.scheme) return entry.plan(url, format);
        known += (known.empty() ? "" : ", ") + entry.words;
    }
    fail("there is no output {}: outputs are {}", url.shown, known);
}

}  // namespace vantage
