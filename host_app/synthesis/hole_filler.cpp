#include "host_app/synthesis/hole_filler.h"

namespace vantage {

HoleFiller::Level::Level(cv::Size size)
    : colour(TextureFormat::rgba8, size.width, size.height),
      depth_m(TextureFormat::r32f, size.width, size.height),
      target({&colour, &depth_m}),
      filled(TextureFormat::rgba8, size.width, size.height, Filter::linear),
      filled_target({&filled}) {}

HoleFiller::HoleFiller(const ShaderLibrary& library)
    : pull_(library, "holes_pull.frag"), push_(library, "holes_push.frag") {}

void HoleFiller::resize(cv::Size size) {
    if (filled_ && filled_->size() == size) return;
    levels_.clear();
    filled_target_.reset();
    filled_.emplace(TextureFormat::rgba8, size.width, size.height, Filter::linear);
    filled_target_.emplace(std::initializer_list<const Texture*>{&*filled_});
    while (size.width > 1 || size.height > 1) {
        size = {(size.width + 1) / 2, (size.height + 1) / 2};
        levels_.push_back(std::make_unique<Level>(size));
    }
}

const Texture& HoleFiller::fill(const Texture& colour, const Texture& depth_m) {
    resize(colour.size());
    const Texture* fine_colour = &colour;
    const Texture* fine_depth_m = &depth_m;
    for (const auto& level : levels_) {
        Program& program = pull_.use();
        program.input("colour", *fine_colour);
        program.input("depth_m", *fine_depth_m);
        pull_.draw(level->target);
        fine_colour = &level->colour;
        fine_depth_m = &level->depth_m;
    }
    const Texture* coarse = fine_colour;
    for (std::size_t i = levels_.size(); i-- > 0;) {
        const bool is_finest = i == 0;
        Program& program = push_.use();
        program.input("known", is_finest ? colour : levels_[i - 1]->colour);
        program.input("coarse", *coarse);
        program.set("filled_alpha", is_finest ? 64.0f / 255.0f : 1.0f);
        push_.draw(is_finest ? *filled_target_ : levels_[i - 1]->filled_target);
        coarse = is_finest ? &*filled_ : &levels_[i - 1]->filled;
    }
    return levels_.empty() ? colour : *filled_;
}

}  // namespace vantage
