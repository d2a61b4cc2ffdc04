#include "common/config/lens_name.h"

namespace vantage {

const char* lens_name(LensModel lens) { return lens == LensModel::fisheye ? "fisheye" : "pinhole"; }

std::optional<LensModel> lens_named(std::string_view name) {
    for (const LensModel lens : {LensModel::pinhole, LensModel::fisheye})
        if (name == lens_name(lens)) return lens;
    return {};
}

}  // namespace vantage
