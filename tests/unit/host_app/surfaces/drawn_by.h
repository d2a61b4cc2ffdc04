#pragma once

#include <algorithm>

#include <opencv2/core.hpp>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

inline Texture texture_of(TextureFormat format, const cv::Mat& texels,
                          Filter filter = Filter::nearest) {
    Texture texture(format, texels.cols, texels.rows, filter);
    texture.upload(texels);
    return texture;
}

/// Draws a pass, in use and with its inputs set, into a texture and reads it back.
inline cv::Mat drawn_by(FullscreenPass& pass, const Texture& target) {
    pass.draw(Framebuffer{&target});
    return target.download();
}

/// A texel; outside the border, the nearest one inside.
template <typename T>
const T& clamped(const cv::Mat_<T>& texels, int x, int y) {
    return texels(std::clamp(y, 0, texels.rows - 1), std::clamp(x, 0, texels.cols - 1));
}

}  // namespace vantage
