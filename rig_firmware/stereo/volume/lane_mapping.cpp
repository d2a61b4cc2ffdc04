#include "rig_firmware/stereo/volume/lane_mapping.h"

#include <algorithm>
#include <array>

#include "common/gl/context/limits.h"

namespace vantage {

LaneMapping lane_mapping_of(std::string_view renderer) {
    // As Mesa names the Raspberry Pi's: "V3D 7.1.7.0", "V3D 4.2.14.0"; and an RK3588's:
    // "Mali-G610".
    constexpr std::array few_registers = {std::string_view("V3D"), std::string_view("VideoCore"),
                                          std::string_view("Mali")};
    const bool is_narrow =
        std::any_of(few_registers.begin(), few_registers.end(),
                    [&](std::string_view name) { return renderer.starts_with(name); });
    return is_narrow ? LaneMapping::disparities : LaneMapping::pixels;
}

LaneMapping lane_mapping_here() { return lane_mapping_of(GlInfo::query().renderer); }

}  // namespace vantage
