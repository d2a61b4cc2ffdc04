#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/child_program.h"

namespace vantage {
namespace {

TEST(ProbeCommand, LooksAtAnyComputerAndSaysWhatIsUnfit) {
    const ProgramResult result = run_to_end(VANTAGE_RIG, {"probe"});
    EXPECT_EQ(result.status, 0) << result.err;
    for (const char* title : {"Cameras of libcamera:", "Cameras of V4L2:", "GPIO chips:", "GPU:",
                              "Clocks:", "Board and kernel:", "What is unfit for a rig here:"})
        EXPECT_NE(result.out.find(title), std::string::npos) << title;
    EXPECT_EQ(result.err, "");
}

TEST(ProbeCommand, GivesMachinesTheSame) {
    const ProgramResult result = run_to_end(VANTAGE_RIG, {"probe", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json json = nlohmann::json::parse(result.out);
    EXPECT_TRUE(json.at("cameras").at("libcamera").is_array());
    EXPECT_TRUE(json.at("cameras").at("v4l2").is_array());
    EXPECT_TRUE(json.at("gpio").is_array());
    EXPECT_TRUE(json.at("gpu").at("is_software").is_boolean());
    EXPECT_GE(json.at("gpu").at("limits").at("texture_side_px").get<int>(), 4096);
    for (const auto& fit : json.at("gpu").at("fits")) {
        const auto& times = fit.at(fit.contains("measured_ms") ? "measured_ms" : "lower_bounds_ms");
        ASSERT_EQ(times.size(), 3U);
        double least_ms = times.front();
        for (const double ms : times) least_ms = std::min(least_ms, ms);
        EXPECT_GT(least_ms, 0);
        EXPECT_EQ(fit.at("preset").is_null(),
                  least_ms > 1e3 / fit.at("rate_hz").get<double>() * 2 / 3);
    }
    EXPECT_TRUE(json.at("clocks").at("tai_offset_s").is_number_integer());
    EXPECT_FALSE(json.at("known").at("kernel").get<std::string>().empty());
    for (const auto& sentence : json.at("unfit"))
        EXPECT_EQ(sentence.get<std::string>().find('\n'), std::string::npos);
    if (json["cameras"]["libcamera"].empty() && json["cameras"]["v4l2"].empty()) {
        EXPECT_NE(json["unfit"].dump().find("there is no camera"), std::string::npos);
    }
}

}  // namespace
}  // namespace vantage
