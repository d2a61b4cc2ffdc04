#include "rig_firmware/clock/ptp_state_file.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class PtpStateFile : public testing::Test {
  protected:
    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "state.json";
    MonotonicTime start_ = monotonic_from_ns(1'000'000'000'000);
};

TEST_F(PtpStateFile, CarriesPtp4lsWordAndTheKernels) {
    EXPECT_FALSE(read_ptp_state(file_, start_)) << "there is none yet";
    write_ptp_state(
        file_,
        {.ptp = {.port_state = "SLAVE",
                 .offset_ns = -150.5,
                 .path_delay_ns = 1000,
                 .steps_removed = 1},
         .kernel = {.tai_offset_s = 37, .is_synchronized = true, .was_set_lately = true}},
        start_);
    const auto reading = read_ptp_state(file_, start_ + 1s);
    ASSERT_TRUE(reading);
    EXPECT_EQ(reading->ptp.port_state, "SLAVE");
    EXPECT_EQ(reading->ptp.offset_ns, -150.5);
    EXPECT_EQ(reading->ptp.path_delay_ns, 1000);
    EXPECT_EQ(reading->ptp.steps_removed, 1);
    EXPECT_EQ(reading->kernel.tai_offset_s, 37);
    EXPECT_TRUE(reading->kernel.is_synchronized);
    EXPECT_TRUE(reading->is_disciplined());
}

TEST_F(PtpStateFile, SaysWhetherTheClockIsDisciplinedAndWhereNobodyAnswers) {
    const PtpReading follows{.ptp = {.port_state = "SLAVE"}, .kernel = {.was_set_lately = true}};
    EXPECT_EQ(to_json(follows, start_).at("disciplined"), true);
    const PtpReading listens{.ptp = {.port_state = "LISTENING"}, .kernel = {}};
    EXPECT_EQ(to_json(listens, start_).at("disciplined"), false);
    EXPECT_EQ(to_json(std::nullopt, start_).dump(),
              R"({"monotonic_ns":1000000000000,"port_state":null})");
}

TEST_F(PtpStateFile, IsOfNoWorthOnceItIsOldOrFromBeforeTheBoot) {
    write_ptp_state(file_, {}, start_);
    EXPECT_TRUE(read_ptp_state(file_, start_ + ptp_state_lifetime));
    EXPECT_FALSE(read_ptp_state(file_, start_ + ptp_state_lifetime + 1ns));
    EXPECT_FALSE(read_ptp_state(file_, start_ - 1ns));
}

TEST_F(PtpStateFile, DamagedIsNone) {
    for (const char* text : {"", "{", "[]", "{\"monotonic_ns\": 1000000000000}",
                             "{\"monotonic_ns\": \"x\", \"port_state\": \"SLAVE\"}"}) {
        std::ofstream(file_) << text;
        EXPECT_FALSE(read_ptp_state(file_, start_)) << text;
    }
    EXPECT_FALSE(read_ptp_state(folder_.path(), start_)) << "a folder";
}

}  // namespace
}  // namespace vantage
