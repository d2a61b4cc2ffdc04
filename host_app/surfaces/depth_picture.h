#pragma once

#include <optional>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// A render target of the virtual view: rgba8 colour (alpha 0 = empty), r32f depth in metres and,
/// on request, the rigs' shares in the colour (PixelOrigins).
class DepthPicture {
  public:
    /// Allocates the textures; keeps their content if nothing changes. `depth_test` is the target's
    /// depth texture, or null.
    void resize(cv::Size size, bool with_shares = false, const Texture* depth_test = nullptr) {
        if (colour_ && colour_->size() == size && shares_.has_value() == with_shares &&
            depth_test_ == (depth_test ? depth_test->name() : 0))
            return;
        depth_test_ = depth_test ? depth_test->name() : 0;
        target_.reset();
        shares_.reset();
        colour_.emplace(TextureFormat::rgba8, size.width, size.height, Filter::linear);
        depth_m_.emplace(TextureFormat::r32f, size.width, size.height);
        if (with_shares) {
            shares_.emplace(TextureFormat::rgba8, size.width, size.height);
            target_.emplace(std::initializer_list<const Texture*>{&*colour_, &*depth_m_, &*shares_},
                            depth_test);
        } else {
            target_.emplace(std::initializer_list<const Texture*>{&*colour_, &*depth_m_},
                            depth_test);
        }
    }

    void clear() const {
        target_->bind();
        const float nothing[4] = {0, 0, 0, 0};
        glClearBufferfv(GL_COLOR, 0, nothing);
        glClearBufferfv(GL_COLOR, 1, nothing);
        if (shares_) glClearBufferfv(GL_COLOR, 2, nothing);
    }

    const Texture& colour() const { return *colour_; }
    const Texture& depth_m() const { return *depth_m_; }
    /// Null if the picture has no shares.
    const Texture* shares() const { return shares_ ? &*shares_ : nullptr; }
    const Framebuffer& target() const { return *target_; }

  private:
    std::optional<Texture> colour_, depth_m_, shares_;
    std::optional<Framebuffer> target_;
    GLuint depth_test_ = 0;  ///< 0: none
};

}  // namespace vantage
