#include "host_app/programme/coarse_depth.h"

#include <algorithm>

namespace vantage {
namespace {

constexpr int most_columns = 160;

}  // namespace

void CoarseDepth::begin(const Texture& depth_m) {
    const cv::Size size = depth_m.size();
    const int columns = std::min(most_columns, size.width);
    const cv::Size cells(columns, std::max(1, size.height * columns / size.width));
    grid_.resize(cells);
    Program& program = pass_.use();
    program.set("depth_m", 0);
    program.set("cells", Eigen::Vector2i(cells.width, cells.height));
    depth_m.bind(0);
    pass_.draw(grid_.target());
    readback_.begin(grid_.texture());
}

}  // namespace vantage
