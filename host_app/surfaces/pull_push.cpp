#include "host_app/surfaces/pull_push.h"

namespace vantage {
namespace {

/// Halves any image to a single pixel.
constexpr std::size_t to_one_pixel = 32;

}  // namespace

struct PullPush::Pyramid::Level {
    DepthPicture pulled_colour;                      ///< colour and its depth
    DrawnTexture pulled_depth{TextureFormat::r32f};  ///< depth alone
    DrawnTexture pushed;
    Kind kind;

    Level(Kind kind_of_image, cv::Size size)
        : pushed(kind_of_image == Kind::colour ? DrawnTexture(TextureFormat::rgba8, Filter::linear)
                                               : DrawnTexture(TextureFormat::r32f)),
          kind(kind_of_image) {
        if (kind == Kind::colour)
            pulled_colour.resize(size);
        else
            pulled_depth.resize(size);
        pushed.resize(size);
    }
    const Texture& image() const {
        return kind == Kind::colour ? pulled_colour.colour() : pulled_depth.texture();
    }
    const Texture& depth_m() const {
        return kind == Kind::colour ? pulled_colour.depth_m() : pulled_depth.texture();
    }
    const Framebuffer& target() const {
        return kind == Kind::colour ? pulled_colour.target() : pulled_depth.target();
    }
};

void PullPush::Pyramid::resize(Kind kind, cv::Size size, std::size_t max_halvings) {
    if (size_ == size) return;
    size_ = size;
    levels_.clear();
    do {
        size = {(size.width + 1) / 2, (size.height + 1) / 2};
        levels_.push_back(std::make_shared<Level>(kind, size));
    } while (levels_.size() < max_halvings && (size.width > 1 || size.height > 1));
}

PullPush::PullPush(const ShaderLibrary& library, Kind kind)
    : pull_(library, "fill_pull.frag", {{"COLOUR", kind == Kind::colour ? "1" : "0"}}),
      push_(library, "fill_push.frag", {{"COLOUR", kind == Kind::colour ? "1" : "0"}}) {}

void PullPush::fill(const Texture& image, const Texture& depth_m, const Pyramid& pyramid,
                    const Framebuffer& filled) {
    const auto& levels = pyramid.levels_;
    const Texture* fine = &image;
    const Texture* fine_depth_m = &depth_m;
    for (const auto& level : levels) {
        Program& program = pull_.use();
        program.input("image", *fine);
        program.input("depth_map", *fine_depth_m);
        pull_.draw(level->target());
        fine = &level->image();
        fine_depth_m = &level->depth_m();
    }
    const Texture* coarse = fine;
    for (std::size_t i = levels.size(); i-- > 0;) {
        Program& program = push_.use();
        program.input("known", i == 0 ? image : levels[i - 1]->image());
        program.input("coarse", *coarse);
        program.set("filled_alpha", i == 0 ? 64.0f / 255.0f : 1.0f);
        push_.draw(i == 0 ? filled : levels[i - 1]->pushed.target());
        if (i > 0) coarse = &levels[i - 1]->pushed.texture();
    }
}

const Texture& HoleFiller::fill(const Texture& colour, const Texture& depth_m) {
    pyramid_.resize(PullPush::Kind::colour, colour.size(), to_one_pixel);
    filled_.resize(colour.size());
    fill_.fill(colour, depth_m, pyramid_, filled_.target());
    return filled_.texture();
}

}  // namespace vantage
