#include "rig_firmware/capture/stereo_source.h"

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/config/rig_config.h"

namespace vantage {

SourceEntry find_source(const RigConfig& config) {
    std::vector<std::string> known;
    for (SourceEntry& entry : source_entries()) {
        if (entry.kind == config.source.kind) return std::move(entry);
        known.push_back(entry.kind);
    }
    fail("there is no source kind '{}'; {}", config.source.kind,
         suggest_name(config.source.kind, known));
}

std::unique_ptr<StereoSource> make_source(const RigConfig& config) {
    return find_source(config).make(config);
}

}  // namespace vantage
