#pragma once

#include <array>
#include <optional>

#include "common/gl/buffer.h"
#include "host_app/synthesis/depth_picture.h"

namespace vantage {

/// The farthest steady depth and colour that one rig has seen, of its depth map's size: 16 bytes a
/// pixel for two copies, between which learning alternates, and the coarse grid's triangles. The
/// colour's alpha is how well the pixel is confirmed; 0: nothing was learnt.
class LearntPlate {
  public:
    /// A pixel is told before no fewer instants; until then there is nothing to show.
    static constexpr int confirmations = 3;

    bool is_known() const { return instants_ >= confirmations; }
    bool is_empty() const { return instants_ == 0; }
    void forget() { instants_ = 0; }

    /// Precondition: not empty.
    const DepthPicture& now() const { return copies_[now_]; }
    /// To draw the next instant's plate into; finish() makes it the present one.
    const DepthPicture& next(cv::Size size) {
        if (is_empty()) copies_[now_].resize(size);
        copies_[1 - now_].resize(size);
        return copies_[1 - now_];
    }
    void finish() {
        now_ = 1 - now_;
        ++instants_;
        has_triangles_ = false;
    }

    /// Of the coarse grid; the caller writes them where has_triangles() says that there are none.
    const Buffer& triangles(int indices) {
        const std::size_t bytes = static_cast<std::size_t>(indices) * sizeof(std::uint32_t);
        if (!triangles_ || triangle_bytes_ != bytes) triangles_.emplace(bytes, GL_DYNAMIC_DRAW);
        triangle_bytes_ = bytes;
        return *triangles_;
    }
    bool has_triangles() const { return has_triangles_; }
    void set_has_triangles() { has_triangles_ = true; }

  private:
    std::array<DepthPicture, 2> copies_;
    std::size_t now_ = 0, triangle_bytes_ = 0;
    long instants_ = 0;
    bool has_triangles_ = false;
    std::optional<Buffer> triangles_;
};

}  // namespace vantage
