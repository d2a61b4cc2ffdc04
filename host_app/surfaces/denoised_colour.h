#pragma once

#include <array>
#include <optional>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// GPU state of temporal denoising: the denoised picture (rgba8, with mip levels) and the mean
/// (rgba16f). The old copies of both are read while the new ones are drawn. The mean's alpha counts
/// its instants and falls where the picture changes.
class DenoisedColour {
  public:
    /// Whether picture() and mean() hold anything.
    bool is_drawn() const { return is_drawn_; }
    const Texture& picture() const { return sized_->pictures[sized_->now]; }
    const Texture& mean() const { return sized_->means[sized_->now]; }

    /// Starts again if the size changes.
    void resize(cv::Size size) {
        if (sized_ && sized_->pictures[0].size() == size) return;
        sized_.emplace(size);
        is_drawn_ = false;
    }
    /// Continues from a mean that was read back: rgba16f, of the same size.
    void restore(const cv::Mat& mean) {
        sized_->means[sized_->now].upload(mean);
        is_drawn_ = true;
    }
    /// The target of the next draw: the picture and the new mean.
    const Framebuffer& next_target(cv::Size size) {
        resize(size);
        return sized_->targets[1 - sized_->now];
    }
    void finish() {
        sized_->now = 1 - sized_->now;
        is_drawn_ = true;
    }
    void generate_mipmaps() { sized_->pictures[sized_->now].generate_mipmaps(); }
    void forget() { is_drawn_ = false; }

  private:
    struct Sized {
        std::array<Texture, 2> pictures, means;
        std::array<Framebuffer, 2> targets;
        std::size_t now = 0;

        explicit Sized(cv::Size size)
            : pictures{picture_of(size), picture_of(size)},
              means{mean_of(size), mean_of(size)},
              targets{Framebuffer{&pictures[0], &means[0]}, Framebuffer{&pictures[1], &means[1]}} {}
        static Texture picture_of(cv::Size size) {
            return {TextureFormat::rgba8, size.width, size.height, Filter::linear, true};
        }
        static Texture mean_of(cv::Size size) {
            return {TextureFormat::rgba16f, size.width, size.height, Filter::linear};
        }
    };

    std::optional<Sized> sized_;
    bool is_drawn_ = false;
};

}  // namespace vantage
