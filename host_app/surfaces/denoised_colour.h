#pragma once

#include <array>
#include <optional>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// A rig's picture without the noise that stands still, and the mean of instants that it is made
/// of: rgba8 with a mip chain, and rgba16f in two copies, of which the one before is read while the
/// next is drawn. The mean's alpha counts its instants, and falls where the picture changes.
class DenoisedColour {
  public:
    /// Whether picture() and mean() hold anything.
    bool is_drawn() const { return is_drawn_; }
    const Texture& picture() const { return sized_->picture; }
    const Texture& mean() const { return sized_->means[sized_->now]; }

    /// Another size begins anew.
    void resize(cv::Size size) {
        if (sized_ && sized_->picture.size() == size) return;
        sized_.emplace(size);
        is_drawn_ = false;
    }
    /// Goes on from a mean, rgba16f of the size, that was read back before.
    void restore(const cv::Mat& mean) {
        sized_->means[sized_->now].upload(mean);
        is_drawn_ = true;
    }
    /// Of the picture and the next mean.
    const Framebuffer& next_target(cv::Size size) {
        resize(size);
        return sized_->targets[1 - sized_->now];
    }
    void finish() {
        sized_->now = 1 - sized_->now;
        is_drawn_ = true;
    }
    void generate_mipmaps() { sized_->picture.generate_mipmaps(); }
    void forget() { is_drawn_ = false; }

  private:
    struct Sized {
        Texture picture;
        std::array<Texture, 2> means;
        std::array<Framebuffer, 2> targets;
        std::size_t now = 0;

        explicit Sized(cv::Size size)
            : picture(TextureFormat::rgba8, size.width, size.height, Filter::linear, true),
              means{mean_of(size), mean_of(size)},
              targets{Framebuffer{&picture, &means[0]}, Framebuffer{&picture, &means[1]}} {}
        static Texture mean_of(cv::Size size) {
            return {TextureFormat::rgba16f, size.width, size.height, Filter::linear};
        }
    };

    std::optional<Sized> sized_;
    bool is_drawn_ = false;
};

}  // namespace vantage
