#include "host_app/session/options/stereoscopic_options.h"

#include <algorithm>
#include <cstdio>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr int most_quilt_views = 128;

cv::Size parse_quilt(const std::string& text) {
    int columns = 0, rows = 0, used = 0;
    if (std::sscanf(text.c_str(), "%3dx%3d%n", &columns, &rows, &used) != 2 ||
        static_cast<std::size_t>(used) != text.size() || columns < 1 || rows < 1 ||
        columns * rows < 2 || columns * rows > most_quilt_views)
        fail("--quilt is COLUMNSxROWS of 2 to {} views, such as 8x6, not '{}'", most_quilt_views,
             text);
    return {columns, rows};
}

}  // namespace

std::optional<Stereoscopy> StereoscopicOptions::stereoscopy() const {
    if (!quilt.empty() && layout != "quilt")
        fail("--quilt is of --stereoscopic quilt, not of {}", layout);
    if (layout == "off") return std::nullopt;
    const auto names = stereo_layout_names();
    Stereoscopy chosen = eyes;
    chosen.layout =
        static_cast<StereoLayout>(std::find(names.begin(), names.end(), layout) - names.begin());
    if (!quilt.empty()) chosen.quilt = parse_quilt(quilt);
    return chosen;
}

}  // namespace vantage
