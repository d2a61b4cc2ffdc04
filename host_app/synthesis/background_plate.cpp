#include "host_app/synthesis/background_plate.h"

#include <algorithm>

#include "host_app/instants/depth_edges.h"
#include "host_app/instants/projection.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

BackgroundPlates::BackgroundPlates(const ShaderLibrary& library)
    : library_(&library), rasteriser_(library) {}

FullscreenPass& BackgroundPlates::pass(std::size_t layers) {
    std::optional<FullscreenPass>& one = show_[layers - 1];
    if (!one)
        one.emplace(*library_, "plate_show.frag",
                    ShaderDefines{{"LAYERS", std::to_string(layers)}});
    return *one;
}

const DepthPicture& BackgroundPlates::show(const DepthPicture& picture, const RigLayers& layers,
                                           const VirtualView& target, std::size_t most) {
    const DepthPicture* shown = &picture;
    std::size_t count = 0;
    const cv::Size size = picture.colour().size();
    const double near_m = near_plane_m(layers.used());
    for (const DrawnLayer& used : layers.used()) {
        const RigSurface* view = used.surface;
        const RigPlate* plate = view->plate();
        if (!plate) continue;
        if (count == std::min(most, most_shown)) break;
        layer_.resize(size);
        shown_[count].resize(size);
        const DepthGrid grid{plate->picture().depth_m(), plate->triangles(), view->K_depth(),
                             view->camera().world_from_camera, QuadGrid::coarse};
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
        bind("plate_colour", plate->picture().colour());
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
