#pragma once

#include <filesystem>
#include <optional>
#include <utility>

namespace vantage {

/// What became of a published data set.
struct ImportedViews {
    int views = 0, with_geometry = 0;
};

/// Makes a view set (see ViewSet) of one instant of the Microsoft Research 3-D video sequences
/// (Zitnick et al., 2004): `folder` holds calibParams-*.txt and camN/color-camN-fTTT.jpg with
/// camN/depth-camN-fTTT.png. Their image rows count from the bottom and their depth is measured
/// along the axis of one camera for all; both are undone, the former by turning the world's y axis
/// round. Lengths stay in the data's own unit, written as metres. `depth_range` is (MinZ, MaxZ);
/// those of "ballet" and "breakdancers" are known by the name of the parameter file. `instant` is
/// TTT; the first one with a depth map if not given. Throws Error naming the file for whatever is
/// missing or malformed, and if no camera of the instant has a depth map.
ImportedViews import_msr3dvideo(const std::filesystem::path& folder,
                                const std::filesystem::path& view_set, std::optional<int> instant,
                                std::optional<std::pair<double, double>> depth_range);

/// Makes a view set of a Middlebury stereo scene, by what its folder holds: calib.txt (third
/// evaluation and 2014), view0 .. view6 (2005 and 2006), im0 .. im8 with disp2 and disp6 (2001 and
/// 2003), im3 and im4 with disp3 (Tsukuba). Where no camera was published, a nominal one is written
/// down: views between and beside the given ones do not depend on it. Throws Error likewise.
ImportedViews import_middlebury(const std::filesystem::path& folder,
                                const std::filesystem::path& view_set);

}  // namespace vantage
