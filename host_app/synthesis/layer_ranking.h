#pragma once

#include <vector>

#include "host_app/instants/view_ranking.h"
#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// The surfaces of the `rigs` most useful rigs, best first.
inline std::vector<DrawnLayer> layers_of(const Instant& instant, const VirtualView& view,
                                         std::size_t rigs) {
    std::vector<const InstantRig*> all;
    for (const InstantRig& rig : instant.rigs) all.push_back(&rig);
    std::vector<DrawnLayer> layers;
    for (const InstantRig* rig : most_useful(all, view, rigs))
        layers.push_back({rig->surface.get(), rig->presence});
    return layers;
}

/// How many of the layers are drawn by every pixel.
inline std::size_t finely_drawn(const Instant& instant, const RenderLevel& level) {
    return level.rank == 0 && instant.rigs.size() <= most_drawn_rigs ? most_drawn_rigs
                                                                     : level.finely;
}

}  // namespace vantage
