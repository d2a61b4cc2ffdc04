#include "host_app/synthesis/colour_steadier.h"

namespace vantage {

void ColourSteadier::steady(GpuView& view) {
    // Asked for before anything is bound: making a texture binds it.
    const Framebuffer& target = view.next_colour_target();
    const bool has_before = view.has_colour_before();
    Program& program = pass_.use();
    program.set("picture", 0);
    program.set("before", 1);
    program.set("has_before", has_before ? 1.0f : 0.0f);
    view.fresh_colour().bind(0);
    (has_before ? view.colour_mean() : view.fresh_colour()).bind(1);
    pass_.draw(target);
    view.finish_colour();
}

}  // namespace vantage
