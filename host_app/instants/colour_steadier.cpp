#include "host_app/instants/colour_steadier.h"

#include <algorithm>
#include <cmath>

namespace vantage {

float instants_of(double seconds, double dt_s, int fewest, int most) {
    const double instants = dt_s > 0 ? std::round(seconds / dt_s) : most;
    return static_cast<float>(
        std::clamp(instants, static_cast<double>(fewest), static_cast<double>(most)));
}

void ColourSteadier::steady(RigHistory& view) {
    // Asked for before anything is bound: making a texture binds it.
    const Framebuffer& target = view.next_colour_target();
    const bool has_before = view.has_colour_before();
    Program& program = pass_.use();
    program.set("picture", 0);
    program.set("before", 1);
    program.set("has_before", has_before ? 1.0f : 0.0f);
    program.set("most_instants", instants_of(mean_s, view.dt_s(), fewest, most));
    view.fresh_colour().bind(0);
    (has_before ? view.colour_mean() : view.fresh_colour()).bind(1);
    pass_.draw(target);
    view.finish_colour();
}

}  // namespace vantage
