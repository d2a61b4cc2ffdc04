#include <gtest/gtest.h>

#include "host_app/setup/stage_file.h"

namespace vantage {
namespace {

RigStatus good_rig() {
    RigStatus rig;
    rig.rig = "north";
    rig.connected = true;
    rig.stage_rate_hz = rig.sync.rate_hz = 30;
    rig.sync.disciplined = true;
    rig.health.calibration_date = "2026-11-01";
    return rig;
}

std::vector<Finding> findings_for(const RigStatus& rig) {
    ReceiverStatus status;
    status.rigs = {rig};
    return findings_of(status, "stage.toml");
}

TEST(StageFindings, AreEmptyForAGoodRig) { EXPECT_TRUE(findings_for(good_rig()).empty()); }

TEST(StageFindings, DistinguishBlockingFaultsFromOthers) {
    RigStatus rig = good_rig();
    rig.sync.rate_hz = 25;
    rig.sync.disciplined = false;
    rig.health.calibration_date.clear();
    const std::vector<Finding> findings = findings_for(rig);
    ASSERT_EQ(findings.size(), 3u);
    EXPECT_TRUE(findings[0].blocks);
    EXPECT_NE(findings[0].mend.find("rate_hz"), std::string::npos);
    EXPECT_FALSE(findings[1].blocks);
    EXPECT_NE(findings[1].mend.find("vantage-ptp"), std::string::npos);
    EXPECT_NE(findings[2].mend.find("vantage-calib stereo --live stage.toml --rig north="),
              std::string::npos);
}

TEST(StageFindings, ReportOnlyThatARigIsDisconnected) {
    RigStatus rig = good_rig();
    rig.connected = false;
    rig.unreachable = "connection refused";
    rig.health.calibration_date.clear();
    const std::vector<Finding> findings = findings_for(rig);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_TRUE(findings[0].blocks);
    EXPECT_EQ(findings[0].what, "connection refused");
}

TEST(StageFindings, ReportADifferentTaiOffset) {
    RigStatus rig = good_rig();
    rig.sync.tai_offset_s = 37;
    const std::vector<Finding> findings = findings_for(rig);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_TRUE(findings[0].blocks);
    // A rig behind a tunnel has a loopback address and is another computer.
    rig.same_clock = true;
    EXPECT_EQ(findings_for(rig).size(), 1u);
}

}  // namespace
}  // namespace vantage
