#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Side of the square cells in which PathFillPass works.
enum class FillCell { one_px, two_px };
constexpr int px_of(FillCell cell) { return cell == FillCell::one_px ? 1 : 2; }

/// Smallest island, in cells, that is spread. An island's size is an estimate: runs of neighbours
/// within a pixel of each other along the rows, added up along the columns.
inline constexpr int min_island_cells = 32;

/// Makes disparity dense, in cells of some pixels: what stands alone (a small island) is put aside,
/// and what is known spreads along the paths on which the picture changes least, but only to where
/// the other camera could not have seen it. What no path comes to takes the background of its row.
class PathFillPass {
  public:
    PathFillPass(const ShaderLibrary& library, const StereoLayout& layout, FillCell cell);

    /// luma: of the left picture, in LumaPass's form. disparity and filled: in LeftRightPass's
    /// form; confidence of what is filled is 0.
    void run(PassProfiler& profiler, const Buffer& luma, const Buffer& disparity,
             const Buffer& filled);

    std::size_t gpu_bytes() const { return cells_.bytes() + paths_.bytes(); }

  private:
    /// Binds cells and paths and runs `program` over so many invocations.
    void walk(Program& program, int invocations);

    StereoLayout layout_, cell_layout_;
    Program make_cells_, island_rows_, island_columns_, first_rows_, columns_, last_rows_, spread_;
    Buffer cells_, paths_;
};

}  // namespace vantage
