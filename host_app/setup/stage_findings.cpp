#include "host_app/setup/stage_findings.h"

#include <fmt/format.h>

namespace vantage {
namespace {

void add_clock(const RigStatus& rig, std::vector<Finding>& findings) {
    if (!rig.same_clock && !rig.sync.disciplined)
        findings.push_back(
            {rig.rig, false, clock_text(rig),
             "at the rig: sudo systemctl enable --now vantage-ptp vantage-phc2sys, or "
             "vantage-ptp-software where ethtool -T lists no hardware-transmit; the host leads "
             "(docs/build/deploy.md, 5)"});
    if (const std::string worry = tai_warning(rig); !worry.empty())
        findings.push_back(
            {rig.rig, true, worry, "chrony with leapsectz right/UTC on all computers or on none"});
}

void add_calibration(const RigStatus& rig, const std::string& stage_file,
                     std::vector<Finding>& findings) {
    if (!rig.health.calibration_date.empty()) return;
    findings.push_back(
        {rig.rig, false, "it has no calibration file; only a virtual rig films without one",
         fmt::format("vantage-calib stereo --live {} --rig {}=FOLDER --board-file board.toml -o "
                     "FOLDER/calibration.yaml (docs/build/calibration.md)",
                     stage_file, rig.rig)});
}

}  // namespace

std::vector<Finding> findings_of(const ReceiverStatus& status, const std::string& stage_file) {
    std::vector<Finding> findings;
    for (const RigStatus& rig : status.rigs) {
        if (!rig.refused.empty()) {
            findings.push_back({rig.rig, true, rig.refused, ""});
            continue;
        }
        if (!rig.connected) {
            findings.push_back({rig.rig, true, trouble_of(rig),
                                "at the rig: sudo systemctl restart vantage-rig, then: journalctl "
                                "-u vantage-rig"});
            continue;
        }
        if (const std::string trouble = trouble_of(rig); !trouble.empty())
            findings.push_back({rig.rig, true, trouble,
                                trouble == rate_warning(rig)
                                    ? fmt::format("rate_hz in [source] of the rig's rig.toml, or "
                                                  "at the top of {}",
                                                  stage_file)
                                    : ""});
        add_clock(rig, findings);
        add_calibration(rig, stage_file, findings);
    }
    return findings;
}

}  // namespace vantage
