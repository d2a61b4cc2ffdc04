#include "host_app/surfaces/rig_surface.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "common/gl/tile_pass.h"
#include "host_app/views/projection.h"

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

int triangle_indices(cv::Size depth_size) {
    return 6 * (depth_size.width - 1) * (depth_size.height - 1);
}

IndirectTriangles::IndirectTriangles(int max_indices)
    : indices(static_cast<std::size_t>(std::max(max_indices, 1)) * sizeof(std::uint32_t),
              GL_DYNAMIC_DRAW),
      command(5 * sizeof(std::uint32_t), GL_DYNAMIC_DRAW),
      capacity(max_indices) {}

void IndirectTriangles::begin() const {
    const std::array<std::uint32_t, 5> none = {0, 1, 0, 0, 0};
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, command.name());
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof(none), none.data());
    indices.bind_storage(0);
    command.bind_storage(1);
}

void IndirectTriangles::draw() const {
    indices.bind(GL_ELEMENT_ARRAY_BUFFER);
    command.bind(GL_DRAW_INDIRECT_BUFFER);
    glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr);
}

void upload_colour(const DepthView& view, std::unique_ptr<ColourCorrector>& corrector,
                   Texture& into) {
    if (view.colour_correction.is_identity()) {
        into.upload(view.colour);
    } else {
        if (!corrector) corrector = std::make_unique<ColourCorrector>();
        corrector->upload(view.colour, view.colour_correction, into);
    }
}

void RigSurface::begin(const DepthView& camera, cv::Size colour_size, cv::Size depth_size,
                       const SurfaceSamples& samples) {
    camera_ = camera;
    camera_.release_pictures();
    samples_ = samples;
    colour_.resize(colour_size);
    if (shape_.use_count() > 1) shape_ = shapes_->take();
    shape_->has_rims = false;
    shape_->has_fine_grid = true;
    shape_->depth.resize(depth_size);
    if (shape_->grid_size == depth_size) return;
    shape_->triangles.emplace(triangle_indices(depth_size));
    shape_->coarse_triangles.emplace(triangle_indices(depth_size));
    shape_->rims.reset();
    shape_->grid_size = depth_size;
}

void RigSurface::begin_like(const RigSurface& other, const SurfaceSamples& samples) {
    camera_ = other.camera_;
    samples_ = samples;
    colour_.resize(other.colour().size());
    shape_ = other.shape_;
}

void RigSurface::upload(const DepthView& view, std::unique_ptr<ColourCorrector>& corrector,
                        std::unique_ptr<DepthUploader>& uploader) {
    begin(view, view.colour.size(), view.has_depth() ? view.depth_size() : cv::Size(1, 1),
          surface_samples(view));
    if (view.has_depth())
        upload_depth(view, uploader, shape_->depth);
    else
        shape_->depth.texture().upload(DepthImage(1, 1, 0.0f));
    upload_colour(view, corrector, colour_.texture());
    colour_.generate_mipmaps();
}

const IndirectTriangles& RigSurface::rims_to_build() {
    // A quarter of a quad needs as many indices as a whole quad, so this suffices for a picture
    // with a quarter of its pixels at edges.
    if (!shape_->rims) shape_->rims.emplace(std::max(triangle_indices(depth().size()), 24));
    shape_->has_rims = true;
    return *shape_->rims;
}

Eigen::Matrix3d RigSurface::K_depth() const {
    return scaled_intrinsics(camera_.K,
                             static_cast<double>(depth().width_px()) / colour().width_px(),
                             static_cast<double>(depth().height_px()) / colour().height_px());
}

DepthGrid RigSurface::grid(QuadGrid grid) const {
    return {depth(), triangles(grid),      K_depth(), camera_.world_from_camera,
            grid,    depth_spread(camera_)};
}

namespace {

/// Slope of a surface against the line of sight from which on a step in depth is an edge.
constexpr double max_slope = 8.0;
/// A smaller share of the depth is never an edge, since disparities are quantised.
constexpr double min_step = 0.0075;

int quads_across(QuadGrid grid) { return grid == QuadGrid::fine ? 1 : 4; }

Program blocks(const ShaderLibrary& library, QuadGrid grid, bool is_in_tiles = false) {
    return Program::compute(library, "mesh_triangles.comp",
                            {{"STEP", std::to_string(static_cast<int>(grid))},
                             {"ACROSS", std::to_string(quads_across(grid))},
                             {"TILES", is_in_tiles ? "1" : "0"}});
}

}  // namespace

TriangleBuilder::TriangleBuilder(const ShaderLibrary& library)
    : build_(blocks(library, QuadGrid::fine)),
      build_coarse_(blocks(library, QuadGrid::coarse)),
      build_parts_(blocks(library, QuadGrid::coarse, true)),
      build_rims_(Program::compute(library, "mesh_rims.comp")) {}

void TriangleBuilder::build(const DepthGrid& grid, float bend) {
    build(grid, bend, grid.grid == QuadGrid::fine ? build_ : build_coarse_);
}

void TriangleBuilder::build_where(const DepthGrid& grid, const Texture& tiles, cv::Size picture,
                                  float bend) {
    build_parts_.use();
    build_parts_.input("tiles", tiles);
    build_parts_.set("tile_share", TilePass::share_of(picture));
    build(grid, bend, build_parts_);
}

void TriangleBuilder::build(const DepthGrid& grid, float bend, Program& program) {
    if (grid.triangles.capacity == 0) return;
    const int block = static_cast<int>(grid.grid) * quads_across(grid.grid);
    set_edge_filter(program, grid);
    program.set("bend", bend * grid.spread);
    grid.triangles.begin();
    const auto blocks = [&](int px) { return (px - 1 + block - 1) / block; };
    program.dispatch_over(blocks(grid.depth_m.width_px()), blocks(grid.depth_m.height_px()));
    glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void TriangleBuilder::set_edge_filter(Program& program, const DepthGrid& grid) {
    program.use();
    program.input("depth_map", grid.depth_m);
    // The same for all grids: no coarse quad spans what fine ones would not.
    program.set("tolerance", static_cast<float>(std::max(max_slope / grid.K(0, 0), min_step)));
}

void TriangleBuilder::build_rims(RigSurface& surface) {
    if (triangle_indices(surface.depth().size()) == 0) return;
    const IndirectTriangles& rims = surface.rims_to_build();
    const DepthGrid grid = surface.grid(QuadGrid::fine);
    set_edge_filter(build_rims_, grid);
    build_rims_.set("capacity", rims.capacity);
    rims.begin();
    build_rims_.dispatch_over(grid.depth_m.width_px() - 1, grid.depth_m.height_px() - 1);
    glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

}  // namespace vantage
