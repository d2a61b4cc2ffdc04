#include "host_app/session/report/rig_silence.h"

namespace vantage {

bool delivers(const RigStatus& rig, const std::vector<RigStatus>& rigs) {
    return gives_pictures(rig, rigs) && rig.health.published_hz > 0;
}

bool waits_for_a_host(const RigStatus& rig) {
    return rig.connected && rig.sync.ready && rig.sync.role != RigSync::Role::free &&
           rig.sync.first_pulse == 0;
}

std::string silence_of(const RigStatus& rig) {
    if (!trouble_of(rig).empty() || rig.health.published_hz > 0) return {};
    if (waits_for_a_host(rig))
        return "it is connected and sends nothing: it is armed, and films once a host runs the "
               "stage (vantage live)";
    if (rig.health.captured_hz > 0)
        return "it is connected and captures, but sends nothing: see its log at the rig "
               "(journalctl -u vantage-rig) for what is stuck after its cameras";
    return "it is connected and sends nothing, since its cameras deliver nothing: see its log at "
           "the rig (journalctl -u vantage-rig), and vantage-rig probe";
}

}  // namespace vantage
