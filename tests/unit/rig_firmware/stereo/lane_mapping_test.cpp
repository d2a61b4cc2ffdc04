#include "rig_firmware/stereo/volume/lane_mapping.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(LaneMapping, GoesByTheGpu) {
    EXPECT_EQ(lane_mapping_of("V3D 7.1.7.0"), LaneMapping::disparities) << "Raspberry Pi 5";
    EXPECT_EQ(lane_mapping_of("V3D 4.2.14.0"), LaneMapping::disparities) << "Raspberry Pi 4";
    EXPECT_EQ(lane_mapping_of("Mali-G610 (Panfrost)"), LaneMapping::disparities) << "RK3588";
    EXPECT_EQ(lane_mapping_of("llvmpipe (LLVM 19.1.7, 128 bits)"), LaneMapping::pixels)
        << "the processor of a Raspberry Pi, too";
    EXPECT_EQ(lane_mapping_of("NVIDIA H200/PCIe/SSE2"), LaneMapping::pixels);
    EXPECT_EQ(lane_mapping_of("Mesa Intel(R) Graphics (ADL GT2)"), LaneMapping::pixels);
    EXPECT_EQ(lane_mapping_of(""), LaneMapping::pixels);
}

}  // namespace
}  // namespace vantage
