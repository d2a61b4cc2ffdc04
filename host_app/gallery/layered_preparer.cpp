#include "host_app/gallery/layered_preparer.h"

namespace vantage {

void LayeredPreparer::take(std::span<const DepthView> views, double /*dt_s*/) {
    auto instant = std::make_shared<Instant>();
    for (const DepthView& view : views) {
        if (!view.has_depth() || view.colour.empty()) continue;
        const std::shared_ptr<RigSurface> source = surfaces_.take(), main = surfaces_.take(),
                                          boundary = surfaces_.take();
        source->upload(view, corrector_, uploader_);
        splitter_.split(*source, *main, *boundary);
        for (const auto& layer : {main, boundary}) triangles_.build(layer->grid(QuadGrid::fine));
        instant->rigs.push_back({main, boundary});
    }
    instant_ = std::move(instant);
}

std::shared_ptr<const Instant> LayeredPreparer::prepare(const VirtualView& /*target*/,
                                                        const PrepareLevel& /*level*/) {
    return instant_;
}

}  // namespace vantage
