#pragma once

#include <array>
#include <optional>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// GPU state of temporal denoising: the denoised picture (rgba8, with mip levels) and the mean
/// (rgba16f), of which the old copy is read while the new one is drawn. The mean's alpha counts its
/// instants and falls where the picture changes.
class DenoisedColour {
  public:
    /// Whether picture() and mean() hold anything.
    bool is_drawn() const { return is_drawn_; }
    const Texture& picture() const { return sized_->picture; }
    const Texture& mean() const { return sized_->means[sized_->now]; }

    /// Starts again if the size changes.
    void resize(cv::Size size) {
        if (sized_ && sized_->picture.size() == size) return;
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
