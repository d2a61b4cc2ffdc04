#pragma once

#include "common/gl/objects/texture.h"

namespace vantage {

/// A texture that holds a picture, to be given to a pass. Precondition: a context is current.
inline Texture filled_texture(TextureFormat format, const cv::Mat& picture,
                              Filter filter = Filter::nearest) {
    Texture texture(format, picture.cols, picture.rows, filter);
    texture.upload(picture);
    return texture;
}

}  // namespace vantage
