#include "rig_firmware/capture/stereo_source.h"

#include "common/base/error.h"
#include "common/config/rig_config.h"

namespace vantage {

std::unique_ptr<StereoSource> make_source(const RigConfig& config) {
    std::string known;
    for (const SourceEntry& entry : source_entries()) {
        if (entry.kind == config.source.kind) return entry.make(config);
        known += (known.empty() ? "" : ", ") + entry.kind;
    }
    fail("there is no source kind '{}'; the ones there are: {}", config.source.kind, known);
}

}  // namespace vantage
