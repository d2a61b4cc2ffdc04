#include "host_app/synthesis/background_plate.h"

#include "host_app/synthesis/depth_edges.h"
#include "host_app/synthesis/projection.h"
#include "host_app/synthesis/view_ranking.h"

namespace vantage {

BackgroundPlates::BackgroundPlates(const ShaderLibrary& library)
    : library_(&library), learn_(library, "plate_learn.frag"), rasteriser_(library) {}

FullscreenPass& BackgroundPlates::pass(std::size_t layers) {
    std::optional<FullscreenPass>& one = show_[layers - 1];
    if (!one)
        one.emplace(*library_, "plate_show.frag",
                    ShaderDefines{{"LAYERS", std::to_string(layers)}});
    return *one;
}

void BackgroundPlates::learn(GpuView& view) {
    LearntPlate& plate = view.plate();
    const bool has_before = !plate.is_empty();
    // Asked for before anything is bound: making a texture binds it.
    const DepthPicture& next = plate.next(view.depth().size());
    Program& program = learn_.use();
    program.set("depth_map", 0);
    program.set("picture", 1);
    program.set("plate_depth", 2);
    program.set("plate_colour", 3);
    program.set("edge_ratio", depth_edge_ratio);
    program.set("has_before", has_before ? 1.0f : 0.0f);
    view.depth().bind(0);
    view.colour().bind(1);
    plate.now().depth_m().bind(2);
    plate.now().colour().bind(3);
    learn_.draw(next.target());
    plate.finish();
}

const DepthPicture& BackgroundPlates::show(const DepthPicture& picture, const RigLayers& layers,
                                           const VirtualView& target) {
    const DepthPicture* shown = &picture;
    std::size_t count = 0;
    const cv::Size size = picture.colour().size();
    const double near_m = near_plane_m(layers.used());
    for (const GpuView* view : layers.used()) {
        LearntPlate& plate = view->plate();
        if (!plate.is_known() || view->triangle_indices(QuadGrid::coarse) == 0) continue;
        if (count == most_shown) break;
        layer_.resize(size);
        shown_[count].resize(size);
        const DepthGrid grid{plate.now().depth_m(),
                             plate.triangles(view->triangle_indices(QuadGrid::coarse)),
                             view->K_depth(), view->camera().world_from_camera, QuadGrid::coarse};
        if (!plate.has_triangles()) rasteriser_.build_triangles(grid);
        plate.set_has_triangles();
        rasteriser_.draw_depth(grid, target, near_m, layer_.target());

        FullscreenPass& showing = pass(layers.used().size());
        Program& program = showing.use();
        layers.bind(program);
        int unit = layers.first_free_unit();
        const auto bind = [&](const char* name, const Texture& texture) {
            texture.bind(unit);
            program.set(name, unit++);
        };
        bind("picture", shown->colour());
        bind("picture_depth", shown->depth_m());
        bind("plate_layer", layer_.texture());
        bind("plate_colour", plate.now().colour());
        DepthView camera = view->camera();
        camera.K = view->K_depth();
        program.set("plate_from_target",
                    Eigen::Matrix4f(pixel_from_target_pixel(camera, target).cast<float>()));
        program.set("edge_ratio", depth_edge_ratio);
        program.set("remembered_alpha", remembered_alpha / 255.0f);
        showing.draw(shown_[count].target());
        shown = &shown_[count++];
    }
    return *shown;
}

}  // namespace vantage
