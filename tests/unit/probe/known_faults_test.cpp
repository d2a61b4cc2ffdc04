#include "rig_firmware/probe/known_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(KnownFaults, ComparesVersionsAsNumbers) {
    EXPECT_LT(version_number("6.6.9-v8+"), version_number("6.6.20+rpt-rpi-v8"));
    EXPECT_LT(version_number("6.6.74"), version_number("6.12.0"));
    EXPECT_EQ(version_number("4.0-1"), (VersionNumber{4, 0, 0}));
    EXPECT_LT(version_number(""), version_number("3.1.1-4"));
}

TEST(KnownFaults, SaysNothingOfAComputerOfWhichNothingIsKnown) {
    const KnownFaults known = known_faults({"", "6.1.0-40-amd64", false, "3.1.1-4"});
    EXPECT_THAT(known.unfit, IsEmpty());
    EXPECT_THAT(known.notes, IsEmpty());
}

TEST(KnownFaults, KnowsKernelsThatLoseTheEndsOfTriggeredFrames) {
    const std::string pi5 = "Raspberry Pi 5 Model B Rev 1.0";
    EXPECT_THAT(known_faults({pi5, "6.1.77-v8+", true, ""}).unfit,
                Contains(HasSubstr("6.6.20 or newer")));
    EXPECT_THAT(known_faults({pi5, "6.6.20+rpt-rpi-v8", true, ""}).unfit, IsEmpty());
    EXPECT_THAT(known_faults({pi5, "6.1.77-v8+", false, ""}).unfit, IsEmpty()) << "no such sensor";
    EXPECT_THAT(known_faults({pi5, "6.6.20", true, ""}).notes, Contains(HasSubstr("power")));
}

TEST(KnownFaults, KnowsWhatBoardsStampPacketsWith) {
    EXPECT_THAT(known_faults({"Raspberry Pi 4 Model B Rev 1.4", "6.12.1", false, ""}).notes,
                Contains(HasSubstr("rig-software.conf")));
    EXPECT_THAT(known_faults({"Raspberry Pi 5 Model B", "6.12.1", false, ""}).notes,
                Contains(HasSubstr("hybrid_e2e")));
    const std::string cm4 = "Raspberry Pi Compute Module 4 Rev 1.0";
    EXPECT_THAT(known_faults({cm4, "6.12.1", false, "4.2-1"}).unfit,
                Contains(HasSubstr("twoStepFlag")));
    EXPECT_THAT(known_faults({cm4, "6.12.1", false, "3.1.1-4"}).unfit, IsEmpty());
    const std::string cm5 = "Raspberry Pi Compute Module 5 Rev 1.0";
    EXPECT_THAT(known_faults({cm5, "6.12.25", false, ""}).unfit, Contains(HasSubstr("kernel 6.6")));
    EXPECT_THAT(known_faults({cm5, "6.6.74", false, ""}).unfit, IsEmpty());
    EXPECT_THAT(known_faults({cm5, "6.6.74", false, ""}).notes, Contains(HasSubstr("E2E")));
}

}  // namespace
}  // namespace vantage
