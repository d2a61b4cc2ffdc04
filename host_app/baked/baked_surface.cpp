#include "host_app/baked/baked_surface.h"

#include <Eigen/LU>

#include "host_app/views/projection.h"

namespace vantage {

BakedSurface::Part::Part(const BakedPart& part, const DepthView& owner)
    : vertices(Buffer::of(std::span(part.vertices))),
      indices(Buffer::of(std::span(part.indices))),
      measured(static_cast<int>(part.measured)),
      all(static_cast<int>(part.indices.size())),
      sources(part.sources),
      weights(TextureFormat::rgba8, part.weights.cols, part.weights.rows, Filter::linear),
      K(scaled_intrinsics(owner.K, static_cast<double>(part.weights.cols) / owner.colour.cols,
                          static_cast<double>(part.weights.rows) / owner.colour.rows)),
      world_from_owner(owner.world_from_camera) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3f& vertex : part.vertices) sum += vertex.cast<double>();
    middle = world_from_owner * (K.inverse() * sum / static_cast<double>(part.vertices.size()));
    weights.upload(part.weights);
}

BakedSurface::View::View(const DepthView& view)
    : camera(view),
      colour(TextureFormat::rgba8, view.colour.cols, view.colour.rows, Filter::linear, true) {
    camera.release_pictures();
    colour.upload(view.colour);
    colour.generate_mipmaps();
}

void BakedSurface::upload(const BakedBackground& baked) {
    views_.clear();
    parts_.clear();
    for (std::size_t i = 0; i < baked.views.size(); ++i) {
        views_.emplace_back(baked.views[i]);
        if (!baked.parts[i].indices.empty()) parts_.emplace_back(baked.parts[i], baked.views[i]);
    }
}

int BakedSurface::triangles() const {
    int count = 0;
    for (const Part& part : parts_) count += part.all / 3;
    return count;
}

}  // namespace vantage
