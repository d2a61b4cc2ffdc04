#pragma once

#include <filesystem>
#include <optional>
#include <utility>

namespace vantage {

/// The result of importing a published data set.
struct ImportedViews {
    int views = 0, with_geometry = 0;
};

/// Imports one instant of a Microsoft Research 3-D video sequence (Zitnick et al., 2004) as a
/// ViewSet. `folder` contains calibParams-*.txt and camN/color-camN-fTTT.jpg with
/// camN/depth-camN-fTTT.png. The data set counts image rows from the bottom and measures all depth
/// along the axis of one camera; both are converted, the former by inverting the world's y axis.
/// Lengths keep the data's unit. `depth_range` is (MinZ, MaxZ); those of "ballet" and
/// "breakdancers" are known by the name of the parameter file. `instant` is TTT; by default the
/// first one with a depth map. Throws Error naming the file for missing or malformed data, and if
/// no camera of the instant has a depth map.
ImportedViews import_msr3dvideo(const std::filesystem::path& folder,
                                const std::filesystem::path& view_set, std::optional<int> instant,
                                std::optional<std::pair<double, double>> depth_range);

/// Imports a Middlebury stereo scene as a ViewSet. The kind follows from the folder's files:
/// calib.txt (third evaluation and 2014), view0 .. view6 (2005 and 2006), im0 .. im8 with disp2 and
/// disp6 (2001 and 2003), im3 and im4 with disp3 (Tsukuba). Where no camera was published, a
/// nominal one is used: views between and beside the given ones do not depend on it. Throws Error
/// likewise.
ImportedViews import_middlebury(const std::filesystem::path& folder,
                                const std::filesystem::path& view_set);

}  // namespace vantage
