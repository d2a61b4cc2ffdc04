#pragma once

#include <array>
#include <optional>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// The other attachments of a DrawnTexture's target.
enum class DrawnWith { nothing, depth_test };

/// A texture with a framebuffer to draw into it; allocated when its size changes.
class DrawnTexture {
  public:
    explicit DrawnTexture(TextureFormat format, Filter filter = Filter::nearest,
                          bool mipmapped = false, DrawnWith with = DrawnWith::nothing)
        : format_(format), filter_(filter), mipmapped_(mipmapped), with_(with) {}

    void resize(cv::Size size) {
        if (texture_ && texture_->size() == size) return;
        target_.reset();
        texture_.emplace(format_, size.width, size.height, filter_, mipmapped_);
        if (with_ == DrawnWith::depth_test)
            depth_test_.emplace(TextureFormat::depth24, size.width, size.height);
        target_.emplace(std::initializer_list<const Texture*>{&*texture_},
                        depth_test_ ? &*depth_test_ : nullptr);
    }
    bool empty() const { return !texture_; }
    const Texture& texture() const { return *texture_; }
    /// For uploads.
    Texture& texture() { return *texture_; }
    const Framebuffer& target() const { return *target_; }
    /// Precondition: mipmapped.
    void generate_mipmaps() { texture_->generate_mipmaps(); }

  private:
    TextureFormat format_;
    Filter filter_;
    bool mipmapped_;
    DrawnWith with_;
    std::optional<Texture> texture_, depth_test_;
    std::optional<Framebuffer> target_;
};

/// Two textures that take turns: the last result is read while the next one is drawn.
class DrawnInTurn {
  public:
    explicit DrawnInTurn(TextureFormat format)
        : textures_{DrawnTexture(format), DrawnTexture(format)} {}

    /// Whether texture() has content.
    bool is_drawn() const { return is_drawn_; }
    /// The result that was finished last.
    const Texture& texture() const { return textures_[now_].texture(); }
    const Framebuffer& next_target(cv::Size size) {
        textures_[1 - now_].resize(size);
        return textures_[1 - now_].target();
    }
    void finish() {
        now_ = 1 - now_;
        is_drawn_ = true;
    }
    void forget() { is_drawn_ = false; }

  private:
    std::array<DrawnTexture, 2> textures_;
    std::size_t now_ = 0;
    bool is_drawn_ = false;
};

/// A depth24 texture with a framebuffer to draw into it; allocated when its size changes.
class DrawnDepth {
  public:
    void resize(cv::Size size) {
        if (texture_ && texture_->size() == size) return;
        target_.reset();
        texture_.emplace(TextureFormat::depth24, size.width, size.height);
        target_.emplace(std::initializer_list<const Texture*>{}, &*texture_);
    }
    const Texture& texture() const { return *texture_; }
    const Framebuffer& target() const { return *target_; }

  private:
    std::optional<Texture> texture_;
    std::optional<Framebuffer> target_;
};

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
