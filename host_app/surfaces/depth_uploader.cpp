#include "host_app/surfaces/depth_uploader.h"

#include <algorithm>

namespace vantage {
namespace {

/// Side of the square table of all 65536 disparities.
constexpr int table_side = 256;
/// Limits the tables, one for each geometry, that rigs leave behind when they are calibrated again.
constexpr std::size_t max_tables = 64;

}  // namespace

const Texture& DepthUploader::table_of(const DisparityScale& scale) {
    const auto known = std::find_if(tables_.begin(), tables_.end(),
                                    [&](const auto& table) { return table.first == scale; });
    if (known != tables_.end()) return known->second;
    if (tables_.size() >= max_tables) tables_.clear();
    DepthImage depths_m(table_side, table_side);
    for (int steps = 0; steps < table_side * table_side; ++steps)
        depths_m(steps / table_side, steps % table_side) =
            scale.depth_m(static_cast<std::uint16_t>(steps));
    Texture table(TextureFormat::r32f, table_side, table_side);
    table.upload(depths_m);
    return tables_.emplace_back(scale, std::move(table)).second;
}

void DepthUploader::upload(const DepthView& view, DrawnTexture& into) {
    into.resize(view.depth_size());
    if (!steps_ || steps_->size() != view.disparity.size())
        steps_.emplace(TextureFormat::r16ui, view.disparity.cols, view.disparity.rows);
    steps_->upload(view.disparity);
    const Texture& table = table_of(view.disparity_scale);
    Program& program = pass_.use();
    program.input("steps", *steps_);
    program.input("table", table);
    pass_.draw(into.target());
}

void upload_depth(const DepthView& view, std::unique_ptr<DepthUploader>& uploader,
                  DrawnTexture& into) {
    if (!view.disparity.empty()) {
        if (!uploader) uploader = std::make_unique<DepthUploader>();
        uploader->upload(view, into);
    } else {
        into.resize(view.depth_m.size());
        into.texture().upload(view.depth_m);
    }
}

}  // namespace vantage
