#include "calib_tools/bundle/lens_family.h"

#include <algorithm>
#include <string>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr std::array families{
    LensFamily{"none", LensModel::pinhole, 5, {}},
    LensFamily{"radial1", LensModel::pinhole, 5, {true}},
    LensFamily{"radial2", LensModel::pinhole, 5, {true, true}},
    LensFamily{"brown4", LensModel::pinhole, 5, {true, true, true, true}},
    LensFamily{"brown5", LensModel::pinhole, 5, {true, true, true, true, true}},
    LensFamily{"fisheye4", LensModel::fisheye, 4, {true, true, true, true}},
    LensFamily{
        "rational8", LensModel::pinhole, 8, {true, true, true, true, true, true, true, true}},
};

}  // namespace

int LensFamily::free_count() const {
    return static_cast<int>(std::count(free.begin(), free.end(), true));
}

std::span<const LensFamily> lens_families() { return families; }

const LensFamily& lens_family(std::string_view name) {
    std::string names;
    for (const LensFamily& family : families) {
        if (family.name == name) return family;
        names += (names.empty() ? "" : ", ") + std::string(family.name);
    }
    fail("there is no lens family '{}'; there are {}", name, names);
}

}  // namespace vantage
