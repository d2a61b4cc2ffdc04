#pragma once

#include "common/gl/objects/texture.h"

namespace vantage {

/// A texture with the content of an image. Precondition: a context is current.
inline Texture filled_texture(TextureFormat format, const cv::Mat& picture,
                              Filter filter = Filter::nearest) {
    Texture texture(format, picture.cols, picture.rows, filter);
    texture.upload(picture);
    return texture;
}

}  // namespace vantage
