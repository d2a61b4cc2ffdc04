#include "rig_firmware/probe/known_faults.h"

#include <sstream>
#include <string>

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

TEST(KnownFaults, TellsOfSensorsThatWaitForPulsesHowTheyFail) {
    const std::vector<std::string> notes = known_faults({"", "6.12.1", true, ""}).notes;
    for (const char* fault : {"time out", "picamera2#748", "libcamera#56", "#80", "picamera2#783",
                              "a frame apart", "picamera2#1116", "picamera2#1107"})
        EXPECT_THAT(notes, Contains(HasSubstr(fault)));
    EXPECT_THAT(known_faults({"", "6.12.1", true, ""}).unfit, IsEmpty());
}

TEST(KnownFaults, TellsOfUncachedPicturesOnAnyRaspberryPi) {
    for (const char* board : {"Raspberry Pi 4 Model B Rev 1.4", "Raspberry Pi 5 Model B Rev 1.0",
                              "Raspberry Pi Compute Module 4 Rev 1.0"})
        EXPECT_THAT(known_faults({board, "6.12.1", false, ""}).notes,
                    Contains(HasSubstr("raspberrypi/linux#5286")))
            << board;
}

TEST(KnownFaults, ReadsWhetherPtpIsToldToTakeOneStep) {
    const auto one_step = [](const char* text) {
        std::istringstream configuration(text);
        return sets_one_step(configuration);
    };
    EXPECT_TRUE(one_step("[global]\ntwoStepFlag             0\nslaveOnly 1\n"));
    EXPECT_TRUE(one_step("twoStepFlag 1\n  twoStepFlag\t0 # late\n"));
    EXPECT_FALSE(one_step("twoStepFlag 0\ntwoStepFlag 1\n"));
    EXPECT_FALSE(one_step("# twoStepFlag 0\n#twoStepFlag 0\n"));
    EXPECT_FALSE(one_step(""));
}

TEST(KnownFaults, KnowsWhatBoardsStampPacketsWith) {
    EXPECT_THAT(known_faults({"Raspberry Pi 4 Model B Rev 1.4", "6.12.1", false, ""}).notes,
                Contains(HasSubstr("rig-software.conf")));
    EXPECT_THAT(known_faults({"Raspberry Pi 5 Model B", "6.12.1", false, ""}).notes,
                Contains(HasSubstr("hybrid_e2e")));
    const std::string cm4 = "Raspberry Pi Compute Module 4 Rev 1.0";
    EXPECT_THAT(known_faults({cm4, "6.12.1", false, "4.2-1"}).unfit,
                Contains(HasSubstr("twoStepFlag")));
    EXPECT_THAT(known_faults({cm4, "6.12.1", false, "4.2-1", true}).unfit, IsEmpty())
        << "it is set already";
    EXPECT_THAT(known_faults({cm4, "6.12.1", false, "3.1.1-4"}).unfit, IsEmpty());
    const std::string cm5 = "Raspberry Pi Compute Module 5 Rev 1.0";
    EXPECT_THAT(known_faults({cm5, "6.12.25", false, ""}).unfit, Contains(HasSubstr("kernel 6.6")));
    EXPECT_THAT(known_faults({cm5, "6.6.74", false, ""}).unfit, IsEmpty());
    EXPECT_THAT(known_faults({cm5, "6.6.74", false, ""}).notes, Contains(HasSubstr("E2E")));
}

}  // namespace
}  // namespace vantage
