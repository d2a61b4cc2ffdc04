#include "host_app/fused/impulse_filter.h"

#include "host_app/views/tolerances.h"

namespace vantage {

const Texture& ImpulseFilter::filter(const Texture& picture, const Texture& depth_m) {
    filtered_.resize(picture.size());
    picture.bind(0);
    depth_m.bind(1);
    pass_.draw(filtered_.target(), [](Program& program) {
        program.set("picture", 0);
        program.set("tolerance", static_cast<float>(tolerance) / 255);
        program.set("depth_m", 1);
        program.set("edge_ratio", depth_edge_ratio);
    });
    return filtered_.texture();
}

}  // namespace vantage
