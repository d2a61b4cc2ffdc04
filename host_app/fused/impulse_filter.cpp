#include "host_app/fused/impulse_filter.h"

#include "host_app/views/tolerances.h"

namespace vantage {

const Texture& ImpulseFilter::filter(const Texture& picture, const Texture& depth_m) {
    filtered_.resize(picture.size());
    pass_.draw(filtered_.target(), [&](Program& program) {
        program.input("picture", picture);
        program.input("depth_m", depth_m);
        program.set("tolerance", static_cast<float>(tolerance) / 255);
        program.set("edge_ratio", depth_edge_ratio);
    });
    return filtered_.texture();
}

}  // namespace vantage
