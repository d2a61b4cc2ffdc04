#pragma once

#include <array>
#include <optional>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "host_app/surfaces/drawn_texture.h"

namespace vantage {

/// GPU state of a rig's background depth: the state (rgba32f, see background_learn.frag; red is the
/// depth in metres), of which the old copy is read while the new one is drawn, and the kinds of the
/// newest instant's pixels (rgba8, see background_compare.frag).
class BackgroundState {
  public:
    /// Whether state() and seen() hold anything.
    bool is_drawn() const { return is_drawn_; }
    const Texture& state() const { return sized_->states[sized_->now]; }
    const Texture& seen() const { return seen_.texture(); }

    /// Starts again if the size changes.
    void resize(cv::Size size) {
        if (sized_ && seen().size() == size) return;
        seen_.resize(size);
        sized_.emplace(size);
        is_drawn_ = false;
    }
    const Framebuffer& seen_target() const { return seen_.target(); }
    const Framebuffer& next_target() const { return sized_->targets[1 - sized_->now]; }
    /// Continues from a state that was read back: rgba32f, of the same size.
    void restore(const cv::Mat4f& state) {
        sized_->states[sized_->now].upload(state);
        is_drawn_ = true;
    }
    void finish() {
        sized_->now = 1 - sized_->now;
        is_drawn_ = true;
    }
    void forget() { is_drawn_ = false; }

  private:
    struct Sized {
        std::array<Texture, 2> states;
        std::array<Framebuffer, 2> targets;
        std::size_t now = 0;

        explicit Sized(cv::Size size)
            : states{state_of(size), state_of(size)},
              targets{Framebuffer{&states[0]}, Framebuffer{&states[1]}} {}
        static Texture state_of(cv::Size size) {
            return {TextureFormat::rgba32f, size.width, size.height};
        }
    };

    DrawnTexture seen_{TextureFormat::rgba8, Filter::nearest, false, DrawnWith::depth_test};
    std::optional<Sized> sized_;
    bool is_drawn_ = false;
};

}  // namespace vantage
