#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/view_ranking.h"

namespace vantage {

/// Returns the `rigs` most useful rigs of an instant for the view, best first.
inline std::vector<const InstantRig*> ranked_rigs(const Instant& instant, const VirtualView& view,
                                                  std::size_t rigs) {
    std::vector<const InstantRig*> all;
    for (const InstantRig& rig : instant.rigs) all.push_back(&rig);
    return most_useful(all, view, rigs);
}

/// Returns one layer of each rig: its background surface, or the foreground in front of it.
inline std::vector<DrawnLayer> layers_of(
    std::span<const InstantRig* const> rigs,
    std::shared_ptr<const RigSurface> InstantRig::*part = &InstantRig::surface) {
    std::vector<DrawnLayer> layers;
    for (const InstantRig* rig : rigs) layers.push_back({(rig->*part).get(), rig->presence});
    return layers;
}

/// Returns the surfaces of the `rigs` most useful rigs as layers, best first.
inline std::vector<DrawnLayer> layers_of(const Instant& instant, const VirtualView& view,
                                         std::size_t rigs) {
    return layers_of(ranked_rigs(instant, view, rigs));
}

/// Returns how many of the layers are drawn with one vertex per pixel.
inline std::size_t finely_drawn(const Instant& instant, const RenderLevel& level) {
    return level.rank == 0 && instant.rigs.size() <= most_drawn_rigs ? most_drawn_rigs
                                                                     : level.finely;
}

}  // namespace vantage
